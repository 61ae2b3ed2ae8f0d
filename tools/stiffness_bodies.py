"""The bodies of tools/stiffness_table.py: a beam, beams of bone and fat, a beam with slivers.

All are 0.1 x 0.1 x 0.4 m, of k x k x 4k cells, z from 0 on, x and y centred, as the shape "beam".
"""

import itertools

SIZE = (0.1, 0.1, 0.4)  # [m]
FAT = 1e3  # Young's modulus beside the bone's [Pa]
FAT_LABEL, BONE_LABEL = 1, 2
THIN = 1e-3  # volume of a sliver over the mean


def lattice(k):
    """(nodes [m], tets, cell of each tet): six tets a cell (Kuhn 1960)."""
    cells = (k, k, 4 * k)
    strides = (1, k + 1, (k + 1) ** 2)
    nodes = [[SIZE[0] * (x / k - 0.5), SIZE[1] * (y / k - 0.5), SIZE[2] * z / cells[2]]
             for z in range(cells[2] + 1) for y in range(k + 1) for x in range(k + 1)]
    tets, owner = [], []
    for cell in itertools.product(*map(range, cells)):
        for order in itertools.permutations(range(3)):
            # From corner to opposite corner, one axis after the other.
            tet = [sum(c * s for c, s in zip(cell, strides))]
            for axis in order:
                tet.append(tet[-1] + strides[axis])
            if order not in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
                tet[2], tet[3] = tet[3], tet[2]
            tets.append(tet)
            owner.append(cell)
    return nodes, tets, owner


def volume(a, b, c, d):
    """Signed volume of a tet [m3]."""
    (ux, uy, uz), (vx, vy, vz), (wx, wy, wz) = ([q - p for p, q in zip(a, x)] for x in (b, c, d))
    return ((uy * vz - uz * vy) * wx + (uz * vx - ux * vz) * wy + (ux * vy - uy * vx) * wz) / 6


def write_medit(file, nodes, tets, labels):
    """A MEDIT mesh in metres."""
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(nodes))]
    lines += [f"{x!r} {y!r} {z!r} 0" for x, y, z in nodes]
    lines += ["Tetrahedra", str(len(tets))]
    lines += [" ".join(str(i + 1) for i in t) + f" {label}" for t, label in zip(tets, labels)]
    file.write_text("\n".join(lines) + "\nEnd\n", encoding="utf-8")


def bone(where):
    """A mesh of fat, with bone in the cells for which `where`(cell, k) holds."""
    def write(file, k):
        nodes, tets, owner = lattice(k)
        labels = [BONE_LABEL if where(cell, k) else FAT_LABEL for cell in owner]
        write_medit(file, nodes, tets, labels)
    return write


def core(cell, k):
    """The middle half of the cross-section, all along."""
    return all(k <= 4 * c + 2 < 3 * k for c in cell[:2])


def layer(cell, k):
    """The lower half, all along."""
    return 2 * cell[1] < k


def far_half(cell, k):
    """The half that is not held: it hangs on the fat."""
    return cell[2] >= 2 * k


def slivers(file, k):
    """A lattice whose nodes of odd index lie almost in a face around them."""
    nodes, tets, _ = lattice(k)
    cell = SIZE[0] / k
    for i, node in enumerate(nodes):
        layer_size = (k + 1) ** 2
        if all(n % 2 == 1 for n in (i % (k + 1), i % layer_size // (k + 1), i // layer_size)):
            # The face opposite of it in the tet along x, y, z has its centroid at (3, 2, 1) / 3.
            nodes[i] = [x + (1 - THIN) * cell * n / 3 for x, n in zip(node, (3, 2, 1))]
    sizes = [volume(*(nodes[i] for i in t)) for t in tets]
    mean = sum(sizes) / len(sizes)
    write_medit(file, nodes, tets, [0] * len(tets))
    return (f"slivers: {len(tets)} tets, {sum(v < 1.001 * THIN * mean for v in sizes)} of at most "
            f"{THIN:g} of the mean volume; smallest {min(sizes) / mean:.3g}, "
            f"largest {max(sizes) / mean:.3g}")


# name -> function that writes its mesh; None: the built-in shape.
MESHES = {"beam": None, "bone-core": bone(core), "bone-layer": bone(layer),
          "bone-end": bone(far_half), "slivers": slivers}


def body_text(name, k, young, poisson, mesh):
    """[body.beam] and its probes; the modulus `young` is the bone's where there is fat."""
    has_fat = name.startswith("bone")
    if MESHES[name] is None:
        shape = f'shape = "beam"\nsize = {list(SIZE)}\ncells = [{k}, {k}, {4 * k}]'
    else:
        shape = f'mesh = "{mesh}"'
    text = f"""[body.beam]
{shape}
density = 1060
young = {FAT if has_fat else young:g}
poisson = {poisson}
damping_ratio = 0
"""
    probe = '\n[probe.{0}]\nselect = {{ side = "+z"{1} }}\n'
    if not has_fat:
        return text + "{drag}" + probe.format("tip", "")
    text += f"{{drag}}\n[body.beam.region.bone]\nlabel = {BONE_LABEL}\nyoung = {young:g}\n"
    if name == "bone-end":
        return text + probe.format("tip", "")
    return (text + probe.format("fat", f", label = {FAT_LABEL}")
            + probe.format("bone", f", label = {BONE_LABEL}"))
