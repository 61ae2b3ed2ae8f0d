// The messages of docs/protocol.md.

export const PROTOCOL = 2;
export const HEADER_BYTES = 40;

export type Vec = [number, number, number];

export interface Part {
  body: string;
  region: string;
  law: string;
  young: number;
  poisson: number;
  density: number;
  damping_ratio: number;
  viscosity: number;
  drag: number;
  stretch_limit: number | null; // null: none
  compress_limit: number | null;
}

export interface QuantityInfo {
  name: string;
  title: string;
  unit: string;
  signed: boolean;
}

/** An obstacle of the scene. */
export interface ObstacleInfo {
  name: string;
  radius: number; // of a ball around it [m]; 0 for a plane
  shape: string; // "sphere" and "plane" are drawn by name, others by their triangles
  vertices: number[]; // x, y, z, ... in its own axes [m]
  normals: number[]; // x, y, z, ... of the vertices; empty: those of the triangles
  triangles: number[]; // indices of vertices
}

/** A half of the tets that is not shown: those whose middle X at rest has normal · X > offset [m]. */
export interface CutPlane {
  normal: Vec;
  offset: number;
}

export interface SceneInfo {
  type: "scene";
  opened: number; // counts scenes that were opened
  revision: number;
  changes: number;
  name: string;
  title: string;
  look_for: string;
  nodes: number;
  tets: number;
  springs: number;
  mass: number;
  diagonal: number;
  gravity: Vec;
  stepper: string;
  dt: number;
  parts: Part[];
  regions: string[];
  quantities: QuantityInfo[];
  ground: { point: Vec; normal: Vec } | null;
  probes: string[];
  obstacles: ObstacleInfo[];
  laws: { name: string; title: string }[]; // for a second body
  compare: string; // the law of the second body; empty without one
  cut: CutPlane | null;
  springs_shown: boolean;
}

export interface HandInfo {
  hand: number;
  at: Vec;
  target: Vec;
  force: Vec;
}

/** Position of a rigid sphere, and the force on it. */
export interface SphereStatus {
  center: Vec;
  radius: number; // [m]
  force: Vec; // on it [N]
  contacts: number;
  turn?: [number, number, number, number]; // of its own axes: quaternion x, y, z, w
}

export interface Status {
  type: "status";
  running: boolean;
  time: number;
  step: number;
  dt: number | null;
  stable_step: number | null;
  stepper: string;
  reason: string;
  time_scale: number;
  rate: number;
  capacity: number | null;
  ms_per_step: number;
  steps_per_frame: number | null;
  newton_per_step: number;
  products_per_newton: number;
  limit: string;
  energy: Record<"kinetic" | "elastic" | "gravity" | "contact" | "dissipated" | "work_in", number>;
  volume_ratio: number;
  max_stretch: number;
  max_compress: number;
  contacts: number; // in the last step
  deepest: number; // penetration since the start [m]
  inverted_tets: number;
  hands: HandInfo[];
  probes: Vec[]; // displacements [m], in the order of the scene's probes
  obstacles: SphereStatus[]; // in the order of the scene's obstacles
  ball: SphereStatus | null;
  distance: { largest: number; mean: number } | null; // from the compared body [m]
  can_undo: boolean; // a cut
  can_redo: boolean;
  cut_area: number; // of all cuts, one side [m2]
  pieces: number; // of the bodies after the last cut; 0: nothing was cut
  error: string;
  errors: number;
}

export type Text =
  | { type: "hello"; protocol: number; version: string; gallery: boolean }
  | { type: "role"; controls: boolean; viewers: number; ticket: string }
  | { type: "error"; message: string }
  | SceneInfo
  | Status;

export interface Topology {
  kind: "topology";
  revision: number;
  triangles: Uint32Array; // 3 nodes each
  springs: Uint32Array; // 2 nodes each; empty unless asked for
  rest: Float32Array; // [m], 3 a node
  region: Uint8Array;
  pinned: Uint8Array;
}

export interface Frame {
  kind: "frame";
  revision: number;
  number: number;
  time: number; // [s]
  quantity: number; // index into SceneInfo.quantities
  position: Float32Array; // [m], 3 a node
  value: Float32Array;
  compared: Float32Array | null; // [m], 3 a node: of the compared body
  contact: Uint8Array | null; // 1: touches the ground, an obstacle, the ball, a body
}

export type Command =
  | { type: "play"; running: boolean }
  | { type: "cancel" }
  | { type: "step"; frame?: boolean }
  | { type: "reset" }
  | { type: "material"; body?: string; region?: string; key: string; value: number | string }
  | { type: "stepping"; key: string; value: number | string }
  | { type: "gravity"; value: Vec }
  | { type: "time_scale"; value: number }
  | { type: "quantity"; value: string }
  | { type: "grab"; hand: number; node: number; point: Vec; radius?: number }
  | { type: "drag"; hand: number; point: Vec }
  | { type: "release"; hand: number }
  | { type: "ball"; point?: Vec; radius?: number }
  | { type: "blade"; node?: number; heel?: Vec; tip?: Vec }
  | { type: "undo" }
  | { type: "redo" }
  | { type: "cut"; normal?: Vec; offset?: number }
  | { type: "springs"; value: boolean }
  | { type: "compare"; law?: string }
  | { type: "open"; scene: string }
  | { type: "open"; file: string }
  | { type: "seen"; frame: number }
  | { type: "control" };

const COMPARED = 1; // flags of a frame
const CONTACTS = 2;

interface Header {
  revision: number;
  nodes: number;
  first: number; // the two numbers that differ between topology and frame
  second: number;
}

/** Reads a binary message. Throws an Error for any other data. */
export function decode(bytes: ArrayBuffer): Topology | Frame {
  if (bytes.byteLength < HEADER_BYTES) throw new Error("a message shorter than its header");
  const view = new DataView(bytes);
  if (view.getUint32(0, true) !== 0x57564e53) throw new Error("not a message of Sinew");
  const version = view.getUint16(4, true);
  if (version !== PROTOCOL) throw new Error(`protocol ${version}, this page knows ${PROTOCOL}`);
  const kind = view.getUint16(6, true);
  const head: Header = {
    revision: view.getUint32(8, true),
    nodes: view.getUint32(12, true),
    first: view.getUint32(32, true),
    second: view.getUint32(36, true),
  };
  if (kind === 1) return topologyOf(bytes, head);
  if (kind === 2) return frameOf(bytes, head, Number(view.getBigUint64(16, true)), view.getFloat64(24, true));
  throw new Error("a message of an unknown kind");
}

function requireLength(bytes: ArrayBuffer, body: number): void {
  if (bytes.byteLength !== HEADER_BYTES + body) throw new Error("a message of the wrong length");
}

function topologyOf(bytes: ArrayBuffer, head: Header): Topology {
  const { revision, nodes, first: triangles, second: springs } = head;
  requireLength(bytes, 12 * triangles + 8 * springs + 14 * nodes);
  const rest = HEADER_BYTES + 12 * triangles;
  const pairs = rest + 12 * nodes;
  const region = pairs + 8 * springs;
  return {
    kind: "topology",
    revision,
    triangles: new Uint32Array(bytes, HEADER_BYTES, 3 * triangles),
    springs: new Uint32Array(bytes, pairs, 2 * springs),
    rest: new Float32Array(bytes, rest, 3 * nodes),
    region: new Uint8Array(bytes, region, nodes),
    pinned: new Uint8Array(bytes, region + nodes, nodes),
  };
}

function frameOf(bytes: ArrayBuffer, head: Header, number: number, time: number): Frame {
  const { revision, nodes, first: quantity, second: flags } = head;
  const compared = (flags & COMPARED) !== 0;
  const contacts = (flags & CONTACTS) !== 0;
  requireLength(bytes, (16 + (compared ? 12 : 0) + (contacts ? 1 : 0)) * nodes);
  const value = HEADER_BYTES + 12 * nodes;
  const other = value + 4 * nodes;
  return {
    kind: "frame",
    revision,
    number,
    time,
    quantity,
    position: new Float32Array(bytes, HEADER_BYTES, 3 * nodes),
    value: new Float32Array(bytes, value, nodes),
    compared: compared ? new Float32Array(bytes, other, 3 * nodes) : null,
    contact: contacts ? new Uint8Array(bytes, other + (compared ? 12 * nodes : 0), nodes) : null,
  };
}
