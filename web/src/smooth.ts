// Corners of a surface that share a normal: round parts look round, edges stay edges.

export interface Corners {
  node: Uint32Array; // surface node of each vertex to draw
  index: Uint32Array; // vertices of the triangles, 3 each
}

/** Splits nodes where the triangles around them meet at more than `angle` [rad] at rest. */
export function splitCorners(triangles: Uint32Array, rest: Float32Array, angle: number): Corners {
  const count = triangles.length / 3;
  const normals = new Float32Array(3 * count);
  for (let t = 0; t < count; ++t) {
    const [a, b, c] = [3 * triangles[3 * t], 3 * triangles[3 * t + 1], 3 * triangles[3 * t + 2]];
    const u = [rest[b] - rest[a], rest[b + 1] - rest[a + 1], rest[b + 2] - rest[a + 2]];
    const v = [rest[c] - rest[a], rest[c + 1] - rest[a + 1], rest[c + 2] - rest[a + 2]];
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const size = Math.hypot(...n) || 1;
    for (let k = 0; k < 3; ++k) normals[3 * t + k] = n[k] / size;
  }
  const least = Math.cos(angle);
  // By node: its vertices, each with the sum of its triangles' normals.
  const groups = new Map<number, { vertex: number; sum: [number, number, number] }[]>();
  const node: number[] = [];
  const index = new Uint32Array(triangles.length);
  for (let i = 0; i < triangles.length; ++i) {
    const at = 3 * Math.floor(i / 3);
    const [x, y, z] = [normals[at], normals[at + 1], normals[at + 2]];
    const own = groups.get(triangles[i]) ?? [];
    let group = own.find(({ sum }) => {
      const size = Math.hypot(...sum) || 1;
      return (x * sum[0] + y * sum[1] + z * sum[2]) / size >= least;
    });
    if (!group) {
      group = { vertex: node.length, sum: [0, 0, 0] };
      node.push(triangles[i]);
      own.push(group);
      groups.set(triangles[i], own);
    }
    group.sum[0] += x;
    group.sum[1] += y;
    group.sum[2] += z;
    index[i] = group.vertex;
  }
  return { node: Uint32Array.from(node), index };
}
