// The stage: camera, lights with soft shadows, ground with its grid.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { RoomEnvironment } from "three/examples/jsm/environments/RoomEnvironment.js";
import { niceAbove } from "./format";

const GRID_VERTEX = `
  varying vec3 place;
  void main() {
    vec4 world = modelMatrix * vec4(position, 1.0);
    place = world.xyz;
    gl_Position = projectionMatrix * viewMatrix * world;
  }`;

// Lines one pixel wide at any distance, every tenth stronger, fading out.
const GRID_FRAGMENT = `
  varying vec3 place;
  uniform float cell, reach;
  uniform vec3 middle, across, along;
  float lines(vec2 at) {
    vec2 width = fwidth(at);
    vec2 near = abs(fract(at - 0.5) - 0.5) / max(width, 1e-6);
    float line = 1.0 - min(min(near.x, near.y), 1.0);
    return line * (1.0 - smoothstep(0.2, 0.6, max(width.x, width.y)));
  }
  void main() {
    vec2 at = vec2(dot(place - middle, across), dot(place - middle, along)) / cell;
    float fade = 1.0 - smoothstep(0.25, 1.0, length(place - middle) / reach);
    float strength = max(0.13 * lines(at), 0.3 * lines(at / 10.0));
    gl_FragColor = vec4(vec3(0.72, 0.8, 0.88), strength * fade);
    if (gl_FragColor.a < 0.004) discard;
  }`;

const ROOM = 1.2; // margin factor around the visible objects
const GLIDE = 450; // [ms]
const HOME = new THREE.Vector3(0.52, 0.3, 0.8).normalize(); // slightly from above and from the side

interface Place {
  position: THREE.Vector3;
  target: THREE.Vector3;
}

/** A motion of the camera. */
interface Glide {
  from: Place;
  to: Place;
  start: number; // [ms]; -1: starts with the next picture
}

export class Stage {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(36, 1, 0.001, 100);
  readonly renderer: THREE.WebGLRenderer;
  readonly controls: OrbitControls;
  cell = 0.1; // of the grid [m]
  readonly modest: boolean; // no graphics card: drawn by the processor
  private readonly sun = new THREE.DirectionalLight(0xfff1e2, 2.6);
  private readonly floor: THREE.Mesh;
  private readonly grid: THREE.Mesh<THREE.PlaneGeometry, THREE.ShaderMaterial>;
  private stale = true;
  private drawnAt = -1e9; // [ms]
  private covered = 0; // [px] of the view on the right
  private glide: Glide | null = null;
  private home: () => Place = () => ({ position: new THREE.Vector3(), target: new THREE.Vector3() });

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    // Without a graphics card a frame takes long: fewer pixels and less light are used.
    const context = this.renderer.getContext();
    const info = context.getExtension("WEBGL_debug_renderer_info");
    const name = info ? String(context.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
    this.modest = /swiftshader|llvmpipe|software/i.test(name) && !location.hash.includes("fine");
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.renderer.toneMapping = THREE.NeutralToneMapping;
    this.renderer.toneMappingExposure = 1.0;
    this.scene.background = backdrop();
    const room = new THREE.PMREMGenerator(this.renderer);
    this.scene.environment = room.fromScene(new RoomEnvironment(), 0.04).texture;
    this.scene.environmentIntensity = 0.45;
    room.dispose();

    this.sun.castShadow = true;
    this.sun.shadow.mapSize.setScalar(this.modest ? 512 : 2048);
    this.sun.shadow.radius = this.modest ? 2 : 7;
    this.sun.shadow.intensity = 0.85;
    const rim = new THREE.DirectionalLight(0x9cc4ff, 0.9);
    rim.position.set(-2, 1.2, -2.5);
    this.scene.add(this.sun, this.sun.target, rim, new THREE.HemisphereLight(0xcfe0f2, 0x3a322d, 0.55));

    // The shadow lies in the plane of the grid, which must stay visible.
    const shade = new THREE.ShadowMaterial({ opacity: 0.42, depthWrite: false });
    this.floor = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), shade);
    this.floor.receiveShadow = true;
    this.grid = new THREE.Mesh(
      new THREE.PlaneGeometry(1, 1),
      new THREE.ShaderMaterial({
        vertexShader: GRID_VERTEX,
        fragmentShader: GRID_FRAGMENT,
        transparent: true,
        depthWrite: false,
        side: THREE.DoubleSide,
        uniforms: {
          cell: { value: 0.1 },
          reach: { value: 1 },
          middle: { value: new THREE.Vector3() },
          across: { value: new THREE.Vector3(1, 0, 0) },
          along: { value: new THREE.Vector3(0, 0, 1) },
        },
      }),
    );
    this.scene.add(this.floor, this.grid);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", () => this.changed());
    this.controls.addEventListener("start", () => (this.glide = null));
  }

  /** Puts camera, sun and ground around a body with these bounds [m]. */
  fit(box: THREE.Box3, ground: { point: number[]; normal: number[] } | null): void {
    const middle = box.getCenter(new THREE.Vector3());
    const size = Math.max(box.getSize(new THREE.Vector3()).length(), 1e-6);
    const normal = ground ? new THREE.Vector3(...ground.normal).normalize() : new THREE.Vector3(0, 1, 0);
    const point = ground
      ? new THREE.Vector3(...ground.point)
      : new THREE.Vector3(middle.x, box.min.y - 0.28 * size, middle.z);
    const under = middle.clone().addScaledVector(normal, -middle.clone().sub(point).dot(normal));
    this.layGround(under, normal, size);

    this.sun.position.copy(middle).add(new THREE.Vector3(0.75, 1.5, 0.9).multiplyScalar(1.6 * size));
    this.sun.target.position.copy(middle);
    const shadow = this.sun.shadow.camera;
    shadow.left = shadow.bottom = -1.5 * size;
    shadow.right = shadow.top = 1.5 * size;
    shadow.near = 0.5 * size;
    shadow.far = 6 * size;
    shadow.updateProjectionMatrix();
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.006 * size;

    this.camera.near = 0.004 * size;
    this.camera.far = 60 * size;
    this.controls.minDistance = 0.05 * size;
    this.controls.maxDistance = 20 * size;
    // Distant enough for the narrower side of the screen, because soft bodies leave their bounds.
    this.home = () => {
      const half = (this.camera.fov / 360) * Math.PI;
      const fit = Math.atan(Math.tan(half) * Math.min(1, this.camera.aspect));
      return { target: middle, position: middle.clone().addScaledVector(HOME, (0.52 * size) / Math.sin(fit)) };
    };
    this.goHome();
  }

  /** Turns to these bounds [m] from the current direction of the camera. */
  include(boxes: THREE.Box3[]): void {
    this.home = () => this.placeFor(boxes, HOME);
    const from: Place = { position: this.camera.position.clone(), target: this.controls.target.clone() };
    const to = this.placeFor(boxes, from.position.clone().sub(from.target).normalize());
    this.glide = { from, to, start: -1 };
    this.changed();
  }

  /** The position from which the camera sees all of it, from a direction, beside overlaid panels. */
  private placeFor(boxes: THREE.Box3[], direction: THREE.Vector3, room = ROOM): Place {
    const all = new THREE.Box3();
    for (const box of boxes) all.union(box);
    const target = all.getCenter(new THREE.Vector3());
    const up = Math.tan((this.camera.fov / 360) * Math.PI);
    const right = up * this.camera.aspect * (1 - this.covered / Math.max(1, this.canvas.clientWidth));
    const turn = new THREE.Matrix4().lookAt(direction, new THREE.Vector3(), this.camera.up).invert();
    let distance = 1e-6;
    for (const corner of boxes.flatMap(cornersOf)) {
      corner.sub(target).applyMatrix4(turn); // z towards the viewer
      distance = Math.max(distance, corner.z + room * Math.max(Math.abs(corner.x) / right, Math.abs(corner.y) / up));
    }
    return { target, position: target.clone().addScaledVector(direction, distance) };
  }

  goHome(): void {
    this.glide = null;
    this.controls.enableDamping = false; // ends damped motion
    this.controls.update();
    this.controls.enableDamping = true;
    this.place(this.home());
  }

  /** Shows these bounds from a direction, at once. */
  look(boxes: THREE.Box3[], direction: THREE.Vector3, room = ROOM): void {
    this.glide = null;
    this.place(this.placeFor(boxes, direction, room));
  }

  private place({ position, target }: Place): void {
    this.camera.position.copy(position);
    this.controls.target.copy(target);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.changed();
  }

  /** The direction from the target to the camera. */
  towardsViewer(): THREE.Vector3 {
    return this.camera.getWorldDirection(new THREE.Vector3()).negate();
  }

  setGrid(on: boolean): void {
    this.grid.visible = on;
    this.changed();
  }

  /** `covered`: covered pixels on the right; the view is centred beside them. */
  resize(width: number, height: number, covered: number): void {
    this.renderer.setPixelRatio(this.modest ? 0.75 * Math.min(window.devicePixelRatio, 1) : Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(1, height);
    this.covered = covered;
    this.camera.setViewOffset(width, height, 0.5 * covered, 0, width, height);
    this.changed();
  }

  /** Requests a redraw. */
  changed(): void {
    this.stale = true;
  }

  /** Draws if anything has changed; without a graphics card less often, so that the page remains
   * responsive. Returns whether it drew. */
  draw(now: number): boolean {
    this.glideOn(now);
    this.controls.update();
    if (!this.stale || (this.modest && now - this.drawnAt < 150)) return false;
    this.stale = false;
    this.drawnAt = now;
    this.renderer.render(this.scene, this.camera);
    return true;
  }

  private glideOn(now: number): void {
    if (!this.glide) return;
    const { from, to } = this.glide;
    if (this.glide.start < 0) this.glide.start = now;
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const t = calm ? 1 : Math.min(1, (now - this.glide.start) / GLIDE);
    const share = t * t * (3 - 2 * t);
    this.camera.position.lerpVectors(from.position, to.position, share);
    this.controls.target.lerpVectors(from.target, to.target, share);
    if (t === 1) this.glide = null;
    this.changed();
  }

  /** The current view as a picture. */
  picture(done: (png: Blob | null) => void): void {
    this.renderer.render(this.scene, this.camera);
    this.canvas.toBlob(done);
  }

  /** Metres per pixel at the distance of the camera's target. */
  metresPerPixel(): number {
    const distance = this.camera.position.distanceTo(this.controls.target);
    const height = 2 * distance * Math.tan((this.camera.fov / 360) * Math.PI);
    return height / Math.max(1, this.canvas.clientHeight);
  }

  private layGround(point: THREE.Vector3, normal: THREE.Vector3, size: number): void {
    const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal);
    this.cell = niceAbove(size / 30);
    for (const plane of [this.floor, this.grid]) {
      plane.position.copy(point);
      plane.quaternion.copy(turn);
      plane.scale.setScalar(12 * size);
    }
    const u = this.grid.material.uniforms;
    u.cell.value = this.cell;
    u.reach.value = 4.5 * size;
    u.middle.value.copy(point);
    u.across.value.set(1, 0, 0).applyQuaternion(turn);
    u.along.value.set(0, 1, 0).applyQuaternion(turn);
  }
}

export function cornersOf({ min, max }: THREE.Box3): THREE.Vector3[] {
  const corners: THREE.Vector3[] = [];
  for (const x of [min.x, max.x]) for (const y of [min.y, max.y]) for (const z of [min.z, max.z]) corners.push(new THREE.Vector3(x, y, z));
  return corners;
}

/** A quiet gradient, lighter around the middle. */
function backdrop(): THREE.Texture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 512;
  const context = canvas.getContext("2d")!;
  const glow = context.createRadialGradient(256, 215, 30, 256, 256, 390);
  glow.addColorStop(0, "#3a4654");
  glow.addColorStop(0.55, "#1f2832");
  glow.addColorStop(1, "#10151b");
  context.fillStyle = glow;
  context.fillRect(0, 0, 512, 512);
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  return texture;
}
