// The page of sinew view: puts its parts together. docs/view.md says what it does.
import * as THREE from "three";
import { Around } from "./around";
import { ColorBar, ScaleBar } from "./colorbar";
import { Connection } from "./connection";
import { h, iconButton, setIcon } from "./dom";
import { digits, length } from "./format";
import { Hands } from "./hands";
import { Help } from "./help";
import { Panel } from "./panel";
import type { Command, Frame, SceneInfo, Status, Text, Topology } from "./protocol";
import { PROTOCOL } from "./protocol";
import { Stage } from "./stage";
import "./style.css";
import { Tissue } from "./tissue";

const PLAIN = "plain";
const SLOW = 0.95; // of the time scale: less is said to be slower than real time

class App {
  private readonly stage = new Stage(document.querySelector<HTMLCanvasElement>("#view")!);
  private readonly tissue = new Tissue();
  private readonly hands: Hands;
  private readonly panel = new Panel((c) => this.send(c));
  private readonly bar = new ColorBar();
  private readonly scale = new ScaleBar();
  private readonly help = new Help();
  private readonly connection: Connection;
  private readonly around: Around;

  private scene: SceneInfo | null = null;
  private status: Status | null = null;
  private frame: Frame | null = null; // the newest, not yet shown
  private shown: Frame | null = null;
  private coloring = PLAIN;
  private controls = false;
  private protocolFault = false;
  private readonly show = { wireframe: false, ghost: false, pins: false, grid: true };
  private framesDrawn = 0;
  private fitted = -1; // the scene that the camera was fitted to, as `opened` counts

  private readonly title = h("h1", {}, "Sinew");
  private readonly lookFor = h("p", { class: "look-for" });
  private readonly clock = h("span", { class: "clock" }, "0.00 s");
  private readonly speed = h("span", { class: "badge" }, "paused");
  private readonly limit = h("div", { id: "limit", role: "status" });
  private readonly role = h("button", { type: "button", class: "text", id: "take-control" }, "Take the controls");
  private readonly lost = h("div", { id: "lost", role: "status" }, "Connecting …");
  private readonly play = iconButton("play", "Run", "Space", () => this.togglePlay());
  private readonly colors = h("select", { id: "coloring", "aria-label": "Colour by", title: "Colour by (C)" });
  private readonly toggles = new Map<string, HTMLInputElement>();
  private readonly tools = new Map<string, HTMLButtonElement>();
  private errorsSeen = -1;

  constructor() {
    this.stage.scene.add(this.tissue.group);
    this.hands = new Hands(this.stage, this.tissue, document.querySelector("#labels")!, (c) => this.send(c));
    this.around = new Around({
      canvas: this.stage.canvas,
      send: (c) => this.send(c),
      picture: (done) => this.stage.picture(done),
      draw: () => this.stage.changed(),
      resized: () => this.resize(),
    });
    this.layOut();
    this.connection = new Connection({
      text: (m) => this.hear(m),
      topology: (t) => this.build(t),
      frame: (f) => (this.frame = f),
      connected: (is) => this.setConnected(is),
      fault: (m) => this.complain(m),
    });
    window.addEventListener("keydown", (e) => this.key(e));
    new ResizeObserver(() => this.resize()).observe(this.stage.canvas.parentElement!);
    this.resize();
    requestAnimationFrame((now) => this.draw(now));
  }

  /** What tests look at. */
  get state() {
    return {
      scene: this.scene,
      status: this.status,
      frame: this.shown?.number ?? 0,
      time: this.shown?.time ?? 0,
      positions: this.tissue.positions,
      rest: this.tissue.rest,
      camera: this.stage.camera.position.toArray(),
      controls: this.controls,
      pulling: this.hands.pulling,
      pins: this.hands.pins,
      drawn: this.framesDrawn,
      samples: this.around.plots.history.length,
      /** Where a surface node is on the page [px]. */
      onPage: (node: number) => {
        const p = this.tissue.point(node, new THREE.Vector3()).project(this.stage.camera);
        const r = this.stage.canvas.getBoundingClientRect();
        return [r.left + 0.5 * r.width * (1 + p.x), r.top + 0.5 * r.height * (1 - p.y)];
      },
    };
  }

  private layOut(): void {
    const step = iconButton("step", "One step", "S", () => this.send({ type: "step" }));
    const reset = iconButton("reset", "Back to the start", "R", () => this.reset());
    for (const [tool, label] of [["pull", "Pull"], ["pin", "Pin"]] as const) {
      const button = iconButton(tool, label, "T", () => this.setTool(tool));
      this.tools.set(tool, button);
    }
    const toggle = (name: keyof typeof this.show, label: string, key: string) => {
      const input = h("input", { type: "checkbox", id: `show-${name}` });
      input.checked = this.show[name];
      input.addEventListener("change", () => this.setShow(name, input.checked));
      this.toggles.set(name, input);
      return h("label", { class: "toggle", title: `${label} (${key})` }, input, h("span", {}, label));
    };
    this.colors.addEventListener("change", () => this.setColoring(this.colors.value));
    this.role.addEventListener("click", () => {
      this.send({ type: "control" });
      this.stage.canvas.focus(); // the button goes away
    });
    const transport = h("div", { id: "transport", role: "toolbar", "aria-label": "Simulation" },
      this.play, step, reset,
      h("span", { class: "line" }), this.clock, this.speed,
      h("span", { class: "line" }), ...this.tools.values());
    const view = h("div", { id: "view-options", role: "toolbar", "aria-label": "View" },
      h("label", { class: "select" }, h("span", {}, "Colour"), this.colors),
      toggle("wireframe", "Wireframe", "W"), toggle("ghost", "Ghost", "U"),
      toggle("pins", "Pins", "N"), toggle("grid", "Grid", "G"));
    const corner = h("div", { id: "corner", role: "toolbar", "aria-label": "More" },
      this.role, ...this.around.buttons,
      iconButton("home", "Whole body in view", "F", () => this.stage.goHome()),
      iconButton("help", "Help", "H", () => this.help.toggle()),
      iconButton("panel", "Panel", "P", () => this.togglePanel()));
    document.querySelector("#ui")!.append(
      h("header", {}, h("div", { class: "heading" }, this.title, this.lookFor, this.bar.element), corner),
      this.panel.element, view, this.scale.element,
      h("footer", {}, this.limit, transport),
      this.lost, this.help.element, ...this.around.elements);
    this.role.hidden = true;
    this.setTool("pull");
    if (innerWidth < 760) document.body.classList.add("no-panel");
  }

  private send(command: Command): boolean {
    if (!this.controls && command.type !== "control" && command.type !== "seen") return false;
    return this.connection.send(command);
  }

  // ---- what the server says ----

  private hear(message: Text): void {
    this.around.hear(message, performance.now());
    switch (message.type) {
      case "hello":
        this.protocolFault = message.protocol !== PROTOCOL;
        if (this.protocolFault) this.complain(`This page is of another version than Sinew ${message.version}: load it again`);
        break;
      case "role":
        this.controls = message.controls;
        this.hands.mayPull = message.controls;
        if (!message.controls) this.hands.forget();
        this.role.hidden = message.controls;
        document.body.classList.toggle("watching", !message.controls);
        this.panel.setEnabled(message.controls);
        break;
      case "scene":
        this.showScene(message);
        break;
      case "status":
        this.showStatus(message);
        break;
      case "error":
        this.complain(message.message);
    }
  }

  private showScene(scene: SceneInfo): void {
    this.scene = scene;
    this.title.textContent = scene.title || scene.name;
    this.lookFor.textContent = scene.look_for;
    document.title = `${scene.title || scene.name} – Sinew`;
    this.panel.showScene(scene);
    this.panel.setEnabled(this.controls);
    if (this.colors.options.length === 0) {
      this.colors.append(h("option", { value: PLAIN }, "Tissue"));
      for (const q of scene.quantities) this.colors.append(h("option", { value: q.name }, q.title));
    }
  }

  private build(topology: Topology): void {
    this.tissue.build(topology);
    this.hands.forget();
    this.shown = null;
    // A cut or springs bring other nodes of the same scene: the view stays where it is.
    if (this.scene && this.scene.opened === this.fitted) return;
    this.stage.fit(new THREE.Box3().setFromArray(topology.rest), this.scene?.ground ?? null);
    this.fitted = this.scene?.opened ?? -1;
  }

  private showStatus(s: Status): void {
    const before = this.status;
    this.status = s;
    setIcon(this.play, s.running ? "pause" : "play", s.running ? "Pause" : "Run", "Space");
    this.panel.showStatus(s);
    this.hands.hear(s.hands);
    const slow = s.running && s.rate > 0 && s.rate < SLOW * s.time_scale;
    this.speed.className = `badge ${!s.running ? "" : slow ? "slow" : "good"}`;
    this.speed.textContent = !s.running ? "paused" : s.rate > 0 ? `${digits(s.rate, 2)}× real time` : "…";
    this.limit.textContent = slow ? `Slower than ${s.time_scale === 1 ? "real time" : "asked for"} – ${s.limit}` : "";
    if (before && s.time < before.time) this.tissue.range.reset();
    if (s.errors !== this.errorsSeen && s.error && this.errorsSeen >= 0) this.complain(s.error);
    this.errorsSeen = s.errors;
  }

  private setConnected(is: boolean): void {
    this.lost.hidden = is;
    if (is) return;
    this.lost.textContent = this.scene ? "Connection lost – trying again …" : "Connecting …";
    this.controls = this.hands.mayPull = false;
    this.hands.forget();
    this.panel.setEnabled(false);
    this.around.disconnected();
  }

  private complain(message: string): void {
    this.around.complain(message);
  }

  // ---- what the user does ----

  private togglePlay(): void {
    this.send({ type: "play", running: !(this.status?.running ?? false) });
  }

  private reset(): void {
    this.hands.forget();
    this.send({ type: "reset" });
    this.tissue.range.reset();
  }

  private setTool(tool: "pull" | "pin"): void {
    this.hands.tool = tool;
    for (const [name, button] of this.tools) button.setAttribute("aria-pressed", String(name === tool));
  }

  private setColoring(name: string): void {
    this.coloring = name;
    this.colors.value = name;
    this.tissue.range.reset();
    if (name !== PLAIN) this.send({ type: "quantity", value: name });
    else if (this.shown) this.tissue.show(this.shown, null, performance.now());
    this.stage.changed();
  }

  private setShow(name: keyof typeof this.show, on: boolean): void {
    this.show[name] = on;
    this.toggles.get(name)!.checked = on;
    this.stage.changed();
    if (name === "wireframe") this.tissue.setWireframe(on);
    if (name === "ghost") this.tissue.setGhost(on);
    if (name === "pins") this.tissue.setPins(on);
    if (name === "grid") this.stage.setGrid(on);
  }

  private togglePanel(): void {
    document.body.classList.toggle("no-panel");
    this.resize();
  }

  private key(event: KeyboardEvent): void {
    const at = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || at.closest("select, input:not([type=checkbox]):not([type=range])")) return;
    const toggle = (name: keyof typeof this.show) => () => this.setShow(name, !this.show[name]);
    const actions: Record<string, () => void> = {
      " ": () => this.togglePlay(),
      s: () => this.send(event.shiftKey ? { type: "step", frame: true } : { type: "step" }),
      r: () => this.reset(),
      t: () => this.setTool(this.hands.tool === "pull" ? "pin" : "pull"),
      escape: () => this.hands.releaseAll(),
      c: () => this.nextColoring(event.shiftKey ? -1 : 1),
      w: toggle("wireframe"),
      u: toggle("ghost"),
      n: toggle("pins"),
      g: toggle("grid"),
      f: () => this.stage.goHome(),
      p: () => this.togglePanel(),
      h: () => this.help.toggle(),
      ...this.around.keys,
    };
    const name = event.key === "?" ? "h" : event.key.toLowerCase();
    // The space bar presses the button that has the focus, as everywhere.
    if (name === " " && at.closest("button, input[type=checkbox], summary")) return;
    const action = actions[name];
    const dialog = document.querySelector<HTMLElement>("dialog[open]"); // only its own key does anything
    if (!action || (dialog && dialog.dataset.key !== name)) return;
    event.preventDefault();
    action();
  }

  private nextColoring(by: number): void {
    const names = [...this.colors.options].map((o) => o.value);
    this.setColoring(names[(names.indexOf(this.coloring) + by + names.length) % names.length]);
  }

  // ---- pictures ----

  private resize(): void {
    const { clientWidth, clientHeight } = this.stage.canvas.parentElement!;
    const { offsetLeft, offsetParent } = this.panel.element;
    const beside = offsetParent !== null || this.panel.element.getClientRects().length > 0;
    const covered = beside && offsetLeft > 0.5 * clientWidth ? clientWidth - offsetLeft : 0;
    this.stage.resize(clientWidth, clientHeight, covered);
  }

  private draw(now: number): void {
    requestAnimationFrame((then) => this.draw(then));
    const frame = this.frame;
    this.frame = null;
    if (frame && this.tissue.fits(frame)) {
      const colored = this.coloring !== PLAIN;
      this.tissue.show(frame, colored ? this.scene : null, now);
      this.shown = frame;
      this.stage.changed();
      this.clock.textContent = `${frame.time.toFixed(2)} s`;
    }
    if (frame) this.send({ type: "seen", frame: frame.number });
    this.bar.show(this.scene, this.coloring === PLAIN ? -1 : (this.shown?.quantity ?? -1), this.tissue.range.top);
    this.hands.update();
    if (this.hands.held.size > 0) this.stage.changed();
    if (!this.stage.draw(now)) return;
    this.scale.show(this.stage.metresPerPixel(), (metres) => length(metres, 1));
    ++this.framesDrawn;
  }
}

declare global {
  interface Window {
    sinew: App;
  }
}
window.sinew = new App();
