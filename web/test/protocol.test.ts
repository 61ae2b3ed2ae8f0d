import { describe, expect, it } from "vitest";
import { decode, HEADER_BYTES } from "../src/protocol";

/** A message as the server writes it. */
function message(kind: number, nodes: number, first: number, body: number, { second = 0, version = 2 } = {}): ArrayBuffer {
  const bytes = new ArrayBuffer(HEADER_BYTES + body);
  const head = new DataView(bytes);
  "SNVW".split("").forEach((c, i) => head.setUint8(i, c.charCodeAt(0)));
  head.setUint16(4, version, true);
  head.setUint16(6, kind, true);
  head.setUint32(8, 7, true);
  head.setUint32(12, nodes, true);
  head.setBigUint64(16, 123n, true);
  head.setFloat64(24, 1.5, true);
  head.setUint32(32, first, true);
  head.setUint32(36, second, true);
  return bytes;
}

describe("decode", () => {
  it("reads a frame", () => {
    const bytes = message(2, 2, 3, 32);
    new Float32Array(bytes, HEADER_BYTES).set([1, 2, 3, 4, 5, 6, 0.5, 0.25]);
    const frame = decode(bytes);
    expect(frame).toMatchObject({ kind: "frame", revision: 7, number: 123, time: 1.5, quantity: 3 });
    if (frame.kind !== "frame") return;
    expect([...frame.position]).toEqual([1, 2, 3, 4, 5, 6]);
    expect([...frame.value]).toEqual([0.5, 0.25]);
    expect(frame.compared).toBeNull();
    expect(frame.contact).toBeNull();
  });

  it("reads what may follow a frame, each by its flag", () => {
    for (const second of [1, 2, 3]) {
      const [compared, contacts] = [(second & 1) !== 0, (second & 2) !== 0];
      const bytes = message(2, 2, 0, 32 + (compared ? 24 : 0) + (contacts ? 2 : 0), { second });
      if (compared) new Float32Array(bytes, HEADER_BYTES + 32, 6).set([6, 5, 4, 3, 2, 1]);
      if (contacts) new Uint8Array(bytes, bytes.byteLength - 2).set([0, 1]);
      const frame = decode(bytes);
      if (frame.kind !== "frame") throw new Error("no frame");
      expect(frame.compared && [...frame.compared]).toEqual(compared ? [6, 5, 4, 3, 2, 1] : null);
      expect(frame.contact && [...frame.contact]).toEqual(contacts ? [0, 1] : null);
    }
  });

  it("reads a topology", () => {
    const bytes = message(1, 3, 1, 12 + 36 + 6);
    new Uint32Array(bytes, HEADER_BYTES, 3).set([0, 2, 1]);
    new Float32Array(bytes, HEADER_BYTES + 12, 9).set([0, 0, 0, 1, 0, 0, 0, 1, 0]);
    new Uint8Array(bytes, HEADER_BYTES + 48).set([0, 1, 2, 0, 0, 1]);
    const t = decode(bytes);
    if (t.kind !== "topology") throw new Error("no topology");
    expect([...t.triangles]).toEqual([0, 2, 1]);
    expect(t.rest[3]).toBe(1);
    expect([...t.region]).toEqual([0, 1, 2]);
    expect([...t.pinned]).toEqual([0, 0, 1]);
    expect(t.springs.length).toBe(0);
  });

  it("reads a topology with springs", () => {
    const bytes = message(1, 3, 1, 12 + 36 + 16 + 6, { second: 2 });
    new Uint32Array(bytes, HEADER_BYTES + 48, 4).set([0, 1, 1, 2]);
    new Uint8Array(bytes, HEADER_BYTES + 64).set([0, 1, 2, 0, 0, 1]);
    const t = decode(bytes);
    if (t.kind !== "topology") throw new Error("no topology");
    expect([...t.springs]).toEqual([0, 1, 1, 2]);
    expect([...t.region]).toEqual([0, 1, 2]);
    expect([...t.pinned]).toEqual([0, 0, 1]);
  });

  it("refuses everything else", () => {
    expect(() => decode(new ArrayBuffer(3))).toThrow("shorter");
    expect(() => decode(new ArrayBuffer(64))).toThrow("not a message");
    expect(() => decode(message(2, 2, 0, 32, { version: 9 }))).toThrow("protocol 9");
    expect(() => decode(message(2, 3, 0, 32))).toThrow("length");
    expect(() => decode(message(2, 2, 0, 32, { second: 1 }))).toThrow("length");
    expect(() => decode(message(1, 3, 1, 54, { second: 1 }))).toThrow("length");
    expect(() => decode(message(5, 2, 0, 32))).toThrow("unknown kind");
  });
});
