// Files for the server: selects those of a scene among the dropped files, and sends them.

export const SCENE = ".toml";
export const MESHES = [".mesh", ".vtk", ".vtu", ".msh", ".node", ".ele"];
export const MOST_BYTES = 64 * 1024 * 1024; // limit of the server for one file
const MOST_TOGETHER = 4 * MOST_BYTES;

export interface Parcel<F> {
  files: { file: F; name: string }[]; // with names that the server accepts
  open: string; // the file to open afterwards
}

const ending = (name: string) => name.slice(Math.max(0, name.lastIndexOf("."))).toLowerCase();
const stem = (name: string) => name.slice(0, name.length - ending(name).length);
const megabytes = (bytes: number) => `${(bytes / 1024 / 1024).toFixed(1)} MiB`;

/** Collects the files to send. Throws an Error with the reason if they cannot be opened. */
export function pack<F extends { name: string; size: number }>(files: F[]): Parcel<F> {
  const odd = files.filter((f) => ![SCENE, ...MESHES].includes(ending(f.name)));
  if (odd.length > 0) {
    throw new Error(`${odd.map((f) => f.name).join(", ")}: not a scene (${SCENE}) or a mesh (${MESHES.join(", ")})`);
  }
  for (const f of files) {
    if (f.size === 0) throw new Error(`${f.name} is empty`);
    if (f.size > MOST_BYTES) throw new Error(`${f.name} has ${megabytes(f.size)}; a file may have at most ${megabytes(MOST_BYTES)}`);
  }
  const together = files.reduce((sum, f) => sum + f.size, 0);
  if (together > MOST_TOGETHER) throw new Error(`The files have ${megabytes(together)}; together they may have at most ${megabytes(MOST_TOGETHER)}`);

  const scenes = files.filter((f) => ending(f.name) === SCENE);
  if (scenes.length > 1) throw new Error(`${scenes.map((f) => f.name).join(", ")}: one scene at a time, please`);
  const taken = /^[A-Za-z0-9._-]+$/;
  if (scenes.length === 1) {
    // The scene names its meshes, so they must keep their names.
    const bad = files.find((f) => f !== scenes[0] && !taken.test(f.name));
    if (bad) throw new Error(`${bad.name}: the name of a mesh that a scene uses may have letters, digits, “.”, “_” and “-” only; rename it here and in the scene`);
    return { files: files.map((file) => ({ file, name: plain(file.name) })), open: plain(scenes[0].name) };
  }
  const nodes = files.find((f) => ending(f.name) === ".node");
  const tets = files.find((f) => ending(f.name) === ".ele");
  if (nodes || tets) {
    if (!nodes || !tets || files.length !== 2 || stem(nodes.name) !== stem(tets.name)) {
      throw new Error("A TetGen mesh is two files of the same name, .node and .ele: drop both");
    }
  } else if (files.length !== 1) {
    throw new Error("Several meshes, and no scene that uses them: drop one mesh, or a scene with its meshes");
  }
  const first = nodes ?? files[0];
  return { files: files.map((file) => ({ file, name: plain(file.name) })), open: plain(first.name) };
}

/** The name without characters that the server does not accept. */
function plain(name: string): string {
  return name.replaceAll(/[^A-Za-z0-9._-]/g, "_");
}

/** Sends a file; `progress` receives the share sent. Rejects with the message of the server. */
export function post(file: Blob, name: string, ticket: string, progress: (share: number) => void): Promise<void> {
  const query = new URLSearchParams(location.search);
  query.set("name", name);
  query.set("ticket", ticket);
  return new Promise((done, failed) => {
    // Not fetch(): it reports no progress.
    const request = new XMLHttpRequest();
    request.open("POST", `/files?${query}`);
    request.upload.addEventListener("progress", (e) => e.lengthComputable && progress(e.loaded / e.total));
    request.addEventListener("load", () => {
      if (request.status === 200) return done();
      failed(new Error(`${name} was not taken (${request.status}): ${request.responseText.trim() || request.statusText}`));
    });
    request.addEventListener("error", () => failed(new Error(`${name} could not be sent: the connection broke`)));
    request.send(file);
  });
}
