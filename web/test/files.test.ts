import { describe, expect, it } from "vitest";
import { MOST_BYTES, pack } from "../src/files";

const file = (name: string, size = 100) => ({ name, size });
const names = (...list: string[]) => pack(list.map((n) => file(n)));

describe("files that were dropped", () => {
  it("make a scene with its meshes", () => {
    const parcel = names("liver.mesh", "My scene.toml");
    expect(parcel.open).toBe("My_scene.toml");
    expect(parcel.files.map((f) => f.name)).toEqual(["liver.mesh", "My_scene.toml"]);
  });
  it("make a mesh alone", () => {
    expect(names("a b.VTK").open).toBe("a_b.VTK");
    expect(names("x.ele", "x.node").open).toBe("x.node");
  });
  it("are refused with the reason", () => {
    expect(() => names("photo.jpg")).toThrow("photo.jpg: not a scene (.toml) or a mesh");
    expect(() => names("README")).toThrow("README: not a scene");
    expect(() => names("a.toml", "b.toml")).toThrow("one scene at a time");
    expect(() => names("a.mesh", "b.mesh")).toThrow("Several meshes");
    expect(() => names("x.node")).toThrow("two files");
    expect(() => names("x.node", "y.ele")).toThrow("two files");
    expect(() => names("a.toml", "my mesh.vtk")).toThrow("rename it");
    expect(() => pack([file("a.mesh", 0)])).toThrow("empty");
    expect(() => pack([file("a.mesh", MOST_BYTES + 1)])).toThrow("64.0 MiB");
    expect(() => pack(["b", "c", "d", "e", "f"].map((n) => file(`${n}.mesh`, MOST_BYTES)).concat(file("a.toml")))).toThrow("together");
  });
});
