// The messages of docs/protocol.md, as this page reads them.

export const PROTOCOL = 1;
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
}

export interface QuantityInfo {
  name: string;
  title: string;
  unit: string;
  signed: boolean;
}

export interface SceneInfo {
  type: "scene";
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
}

export interface HandInfo {
  hand: number;
  at: Vec;
  target: Vec;
  force: Vec;
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
  contacts: number;
  inverted_tets: number;
  hands: HandInfo[];
  error: string;
  errors: number;
}

export type Text =
  | { type: "hello"; protocol: number; version: string }
  | { type: "role"; controls: boolean; viewers: number }
  | { type: "error"; message: string }
  | SceneInfo
  | Status;

export interface Topology {
  kind: "topology";
  revision: number;
  triangles: Uint32Array; // 3 surface nodes each
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
}

export type Command =
  | { type: "play"; running: boolean }
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
  | { type: "seen"; frame: number }
  | { type: "control" };

/** Reads a binary message. Throws an Error on anything that is not one. */
export function decode(bytes: ArrayBuffer): Topology | Frame {
  if (bytes.byteLength < HEADER_BYTES) throw new Error("a message shorter than its header");
  const head = new DataView(bytes);
  if (head.getUint32(0, true) !== 0x57564e53) throw new Error("not a message of Sinew");
  const version = head.getUint16(4, true);
  if (version !== PROTOCOL) throw new Error(`protocol ${version}, this page knows ${PROTOCOL}`);
  const kind = head.getUint16(6, true);
  const revision = head.getUint32(8, true);
  const nodes = head.getUint32(12, true);
  const extra = head.getUint32(32, true);
  const expected = HEADER_BYTES + (kind === 1 ? 12 * extra + 14 * nodes : 16 * nodes);
  if ((kind !== 1 && kind !== 2) || bytes.byteLength !== expected) {
    throw new Error("a message of the wrong length");
  }
  if (kind === 1) {
    const rest = HEADER_BYTES + 12 * extra;
    return {
      kind: "topology",
      revision,
      triangles: new Uint32Array(bytes, HEADER_BYTES, 3 * extra),
      rest: new Float32Array(bytes, rest, 3 * nodes),
      region: new Uint8Array(bytes, rest + 12 * nodes, nodes),
      pinned: new Uint8Array(bytes, rest + 13 * nodes, nodes),
    };
  }
  return {
    kind: "frame",
    revision,
    number: Number(head.getBigUint64(16, true)),
    time: head.getFloat64(24, true),
    quantity: extra,
    position: new Float32Array(bytes, HEADER_BYTES, 3 * nodes),
    value: new Float32Array(bytes, HEADER_BYTES + 12 * nodes, nodes),
  };
}
