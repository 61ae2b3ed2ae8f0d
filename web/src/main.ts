// The page of sinew view: assembles its parts. docs/view.md describes it.
import * as THREE from "three";
import { Around } from "./around";
import { Busy } from "./busy";
import { ColorBar, ScaleBar } from "./colorbar";
import { CompareControl } from "./compare";
import { Connection } from "./connection";
import { CutControl } from "./cut";
import { h, iconButton, setIcon } from "./dom";
import { digits, length } from "./format";
import { Help } from "./help";
import { PLAIN, ViewOptions } from "./options";
import { Panel } from "./panel";
import type { Command, Frame, SceneInfo, Status, Text, Vec } from "./protocol";
import { PROTOCOL } from "./protocol";
import "./style.css";
import "./tools.css";
import { Tools } from "./tools";
import { World } from "./world";

const SLOW = 0.95; // of the time scale: a lower rate is reported as slower than real time
const NARROW = 760; // [px] below which panel and options lie over the view, one at a time

class App {
  private readonly world = new World(
    document.querySelector<HTMLCanvasElement>("#view")!,
    document.querySelector<HTMLElement>("#labels")!,
    (c) => this.send(c),
  );
  private readonly stage = this.world.stage;
  private readonly tools = new Tools(this.world.hands, this.world.ball, this.world.scalpel, (c) => this.send(c));
  private readonly cut = new CutControl((c) => this.send(c), () => this.stage.towardsViewer());
  private readonly options = new ViewOptions({
    send: (c) => this.send(c),
    colored: (name) => this.world.setColored(name !== PLAIN),
    shown: (what, on) => this.world.set(what, on),
  }, this.cut);
  private readonly compare = new CompareControl((c) => this.send(c), (how) => this.world.arrange(how));
  private readonly panel = new Panel((c) => this.send(c), this.compare.element);
  private readonly bar = new ColorBar();
  private readonly scale = new ScaleBar();
  private readonly help = new Help();
  private readonly connection: Connection;
  private readonly around: Around;

  private scene: SceneInfo | null = null;
  private status: Status | null = null;
  private frame: Frame | null = null; // the newest, not yet shown
  private controls = false;
  private protocolFault = false;
  private framesDrawn = 0;

  private readonly title = h("h1", {}, "Sinew");
  private readonly lookFor = h("p", { class: "look-for" });
  private readonly clock = h("span", { class: "clock" }, "0.00 s");
  private readonly speed = h("span", { class: "badge" }, "paused");
  private readonly limit = h("div", { id: "limit", role: "status" });
  private readonly role = h("button", { type: "button", class: "text", id: "take-control" }, "Take the controls");
  private readonly lost = h("div", { id: "lost", role: "status" }, "Connecting …");
  private readonly play = iconButton("play", "Run", "Space", () => this.togglePlay());
  private readonly busy = new Busy(() => this.send({ type: "cancel" }));
  private errorsSeen = -1;

  constructor() {
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
      topology: (t) => {
        this.world.build(t);
        this.cut.setBox(this.world.box);
      },
      frame: (f) => {
        this.busy.heard();
        this.frame = f;
      },
      connected: (is) => this.setConnected(is),
      fault: (m) => this.complain(m),
    });
    window.addEventListener("keydown", (e) => this.key(e));
    new ResizeObserver(() => this.resize()).observe(this.stage.canvas.parentElement!);
    this.resize();
    requestAnimationFrame((now) => this.draw(now));
  }

  /** State for tests. */
  get state() {
    const { tissue, hands, ball, scalpel, spheres, shown } = this.world;
    return {
      scene: this.scene,
      status: this.status,
      frame: shown?.number ?? 0,
      time: shown?.time ?? 0,
      revision: shown?.revision ?? 0,
      positions: tissue.positions,
      rest: tissue.rest,
      springs: tissue.springs,
      contacts: shown?.contact?.reduce((sum, is) => sum + is, 0) ?? 0,
      compared: tissue.compared.shown ? tissue.compared.arrangement : null,
      camera: this.stage.camera.position.toArray(),
      controls: this.controls,
      pulling: hands.pulling,
      pins: hands.pins,
      pushing: ball.pushing,
      cutting: scalpel.cutting,
      ball: spheres.ballAt,
      obstacles: spheres.obstaclesAt,
      drawn: this.framesDrawn,
      samples: this.around.plots.history.length,
      /** Position of a node on the page [px]. */
      onPage: (node: number) => {
        const p = tissue.point(node, new THREE.Vector3()).project(this.stage.camera);
        const r = this.stage.canvas.getBoundingClientRect();
        return [r.left + 0.5 * r.width * (1 + p.x), r.top + 0.5 * r.height * (1 - p.y)];
      },
    };
  }

  /** For the pictures of the documentation: shows everything from a direction, with a margin factor
   * (1: none). */
  look(from: Vec, room?: number): void {
    this.world.look(from, room);
  }

  private layOut(): void {
    const step = iconButton("step", "One step", "S", () => this.send({ type: "step" }));
    const reset = iconButton("reset", "Back to the start", "R", () => this.reset());
    this.role.addEventListener("click", () => {
      this.send({ type: "control" });
      this.stage.canvas.focus(); // the button disappears
    });
    const transport = h("div", { id: "transport", role: "toolbar", "aria-label": "Simulation" },
      this.play, step, reset,
      h("span", { class: "line" }), this.clock, this.speed,
      h("span", { class: "line" }), ...this.tools.buttons);
    const corner = h("div", { id: "corner", role: "toolbar", "aria-label": "More" },
      this.role, ...this.around.buttons,
      iconButton("home", "Whole body in view", "F", () => this.stage.goHome()),
      iconButton("options", "What is shown", "V", () => this.toggleOptions()),
      iconButton("help", "Help", "H", () => this.help.toggle()),
      iconButton("panel", "Panel", "P", () => this.togglePanel()));
    document.querySelector("#ui")!.append(
      h("header", {}, h("div", { class: "heading" }, this.title, this.lookFor, this.bar.element), corner),
      this.panel.element, this.options.element, this.scale.element,
      h("footer", {}, this.around.hint.element, this.limit, ...this.tools.cards, transport),
      this.lost, this.busy.element, this.help.element, ...this.around.elements);
    this.role.hidden = true;
    this.busy.element.hidden = true;
    if (innerWidth < NARROW) document.body.classList.add("no-panel", "no-options");
  }

  private send(command: Command): boolean {
    if (!this.controls && command.type !== "control" && command.type !== "seen") return false;
    if (command.type === "step" || command.type === "reset" || command.type === "stepping") this.busy.expect();
    return this.connection.send(command);
  }

  // ---- messages of the server ----

  private hear(message: Text): void {
    this.busy.heard();
    this.around.hear(message, performance.now());
    switch (message.type) {
      case "hello":
        this.protocolFault = message.protocol !== PROTOCOL;
        if (this.protocolFault) this.complain(`This page is of another version than Sinew ${message.version}: load it again`);
        break;
      case "role":
        this.setControls(message.controls);
        this.role.hidden = message.controls;
        document.body.classList.toggle("watching", !message.controls);
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
    this.world.showScene(scene, this.compare.arrangement);
    this.panel.showScene(scene);
    this.compare.showScene(scene);
    this.options.showScene(scene);
    this.tools.setDiagonal(scene.diagonal);
    this.setEnabled(this.controls);
  }

  private showStatus(s: Status): void {
    const before = this.status;
    this.status = s;
    setIcon(this.play, s.running ? "pause" : "play", s.running ? "Pause" : "Run", "Space");
    this.panel.showStatus(s);
    this.compare.showStatus(s);
    this.world.hear(s);
    this.tools.hear(s);
    const slow = s.running && s.rate > 0 && s.rate < SLOW * s.time_scale;
    this.speed.className = `badge ${!s.running ? "" : slow ? "slow" : "good"}`;
    if (!s.running || s.rate === 0) this.speed.textContent = s.running ? "…" : "paused";
    else this.speed.replaceChildren(`${digits(s.rate, 2)}×`, h("span", { class: "roomy" }, " real time"));
    const why = s.limit && ` – ${s.limit}`;
    this.limit.textContent = slow ? `Slower than ${s.time_scale === 1 ? "real time" : "asked for"}${why}` : "";
    if (before && s.time < before.time) this.world.tissue.range.reset();
    if (s.errors !== this.errorsSeen && s.error && this.errorsSeen >= 0) this.complain(s.error);
    this.errorsSeen = s.errors;
  }

  private setConnected(is: boolean): void {
    this.lost.hidden = is;
    this.busy.heard();
    if (is) return;
    this.lost.textContent = this.scene ? "Connection lost – trying again …" : "Connecting …";
    this.setControls(false);
    this.around.disconnected();
  }

  private setControls(have: boolean): void {
    this.controls = have;
    this.world.setControls(have);
    this.setEnabled(have);
  }

  private setEnabled(on: boolean): void {
    this.panel.setEnabled(on);
    this.options.setEnabled(on);
  }

  private complain(message: string): void {
    this.around.complain(message);
  }

  // ---- actions of the user ----

  private togglePlay(): void {
    this.send({ type: "play", running: !(this.status?.running ?? false) });
  }

  private reset(): void {
    this.world.forget();
    this.send({ type: "reset" });
    this.world.tissue.range.reset();
  }

  private toggleOptions(): void {
    const hidden = document.body.classList.toggle("no-options");
    if (!hidden && innerWidth < NARROW) document.body.classList.add("no-panel");
  }

  private togglePanel(): void {
    const hidden = document.body.classList.toggle("no-panel");
    if (!hidden && innerWidth < NARROW) document.body.classList.add("no-options");
    this.resize();
  }

  private key(event: KeyboardEvent): void {
    const at = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || at.closest("select, input:not([type=checkbox]):not([type=range])")) return;
    const actions: Record<string, () => void> = {
      " ": () => this.togglePlay(),
      s: () => this.send(event.shiftKey ? { type: "step", frame: true } : { type: "step" }),
      r: () => this.reset(),
      t: () => this.tools.next(),
      "[": () => this.tools.deepen(-1),
      "]": () => this.tools.deepen(1),
      z: () => (event.shiftKey ? this.tools.makeAgain() : this.tools.takeBack()),
      escape: () => this.world.releaseAll(),
      c: () => this.options.nextColor(event.shiftKey ? -1 : 1),
      w: () => this.options.toggle("wireframe"),
      u: () => this.options.toggle("ghost"),
      n: () => this.options.toggle("pins"),
      k: () => this.options.toggle("contacts"),
      g: () => this.options.toggle("grid"),
      l: () => this.options.toggleSprings(),
      x: () => this.cut.set(!this.cut.on),
      v: () => this.toggleOptions(),
      f: () => this.stage.goHome(),
      p: () => this.togglePanel(),
      h: () => this.help.toggle(),
      ...this.around.keys,
    };
    const name = event.key === "?" ? "h" : event.key.toLowerCase();
    // The space bar presses the button that has the focus, as everywhere.
    if (name === " " && at.closest("button, input[type=checkbox], summary")) return;
    const action = actions[name];
    const dialog = document.querySelector<HTMLElement>("dialog[open]"); // a dialog reacts only to its own key
    if (!action || (dialog && dialog.dataset.key !== name)) return;
    event.preventDefault();
    action();
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
    this.busy.update(this.status?.running ?? false, this.controls);
    const frame = this.frame;
    this.frame = null;
    if (frame && this.world.show(frame, now)) this.clock.textContent = `${frame.time.toFixed(2)} s`;
    if (frame) this.send({ type: "seen", frame: frame.number });
    const { shown, tissue } = this.world;
    this.bar.show(this.scene, this.options.coloring === PLAIN ? -1 : (shown?.quantity ?? -1), tissue.range);
    if (!this.world.draw(now)) return;
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
