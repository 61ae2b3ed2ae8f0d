// The menu of downloads: picture, video, data of the plots, scene, state.
import { download, h, icon, iconButton } from "./dom";
import { type History, toCsv } from "./history";
import { Recorder, videoKind } from "./recorder";

export interface SaveSources {
  name(): string; // of the files, without extension
  canvas: HTMLCanvasElement;
  history: History;
  picture(done: (png: Blob | null) => void): void;
  draw(): void; // requests a drawing
  complain(message: string): void;
}

interface Entry {
  id: string;
  icon: string;
  title: string;
  what: string;
  act: () => void;
}

export class SaveMenu {
  readonly element: HTMLElement;
  readonly button: HTMLButtonElement;
  /** A red dot and the time during a recording; a click ends it. */
  readonly recording: HTMLButtonElement;
  private readonly recorder: Recorder;
  private readonly video: HTMLButtonElement;

  constructor(private readonly from: SaveSources) {
    this.button = iconButton("save", "Save", "E", () => this.toggle());
    this.button.setAttribute("aria-haspopup", "menu");
    this.button.setAttribute("aria-expanded", "false");
    const items = this.entries().map((entry) => this.item(entry));
    this.video = items[1];
    this.element = h("div", { id: "save-menu", role: "menu", "aria-label": "Save", hidden: true }, ...items);
    this.element.addEventListener("keydown", (e) => this.key(e));
    // A press or the focus elsewhere closes it.
    const left = (e: Event) => {
      const at = e.target as Node;
      if (this.open && !this.element.contains(at) && !this.button.contains(at)) this.toggle(false);
    };
    document.addEventListener("pointerdown", left, { capture: true });
    document.addEventListener("focusin", left);

    this.recording = h("button", { type: "button", id: "recording", hidden: true, title: "Stop and save the video", "aria-label": "Stop the video" });
    this.recording.append(h("i"), h("span"));
    this.recording.addEventListener("click", () => this.recorder.stop());
    this.recorder = new Recorder(from.canvas, {
      draw: () => from.draw(),
      tick: (seconds) => this.tick(seconds),
      done: (video, extension) => download(`${from.name()}.${extension}`, video),
      failed: (why) => from.complain(why),
    });
    this.describeVideo();
  }

  get open(): boolean {
    return !this.element.hidden;
  }

  toggle(open = !this.open): void {
    const inside = this.element.contains(document.activeElement);
    this.element.hidden = !open;
    this.button.setAttribute("aria-expanded", String(open));
    if (open) this.items()[0].focus();
    else if (inside) this.button.focus();
  }

  private entries(): Entry[] {
    const { name, complain, history } = this.from;
    return [
      {
        id: "picture", icon: "camera", title: "Picture", what: "of the view, PNG",
        act: () => this.from.picture((png) => (png ? download(`${name()}.png`, png) : complain("The picture could not be made"))),
      },
      {
        id: "video", icon: "video", title: "", what: "",
        act: () => (this.recorder.running ? this.recorder.stop() : this.recorder.start()),
      },
      {
        id: "data", icon: "plot", title: "Data of the plots", what: "since the start, CSV",
        act: () => download(`${name()}.csv`, new Blob([toCsv(history)], { type: "text/csv" })),
      },
      {
        id: "scene", icon: "file", title: "Scene", what: "with the values as they are, TOML",
        act: () => void this.fetch("/scene.toml", "toml", "The scene"),
      },
      {
        id: "state", icon: "mesh", title: "State", what: "tets with displacement, VTU for ParaView",
        act: () => void this.fetch("/state.vtu", "vtu", "The state"),
      },
    ];
  }

  private item(entry: Entry): HTMLButtonElement {
    const button = h("button", { type: "button", role: "menuitem", id: `save-${entry.id}`, tabindex: -1 },
      icon(entry.icon), h("b", {}, entry.title), h("span", {}, entry.what));
    button.addEventListener("click", () => {
      this.toggle(false);
      entry.act();
    });
    return button;
  }

  private items(): HTMLButtonElement[] {
    return [...this.element.querySelectorAll("button")].filter((b) => !b.disabled);
  }

  private key(event: KeyboardEvent): void {
    const items = this.items();
    const at = items.indexOf(document.activeElement as HTMLButtonElement);
    const to: Record<string, number> = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: items.length - 1 };
    if (event.key in to) items[(to[event.key] + items.length) % items.length].focus();
    else if (event.key === "Escape") this.toggle(false);
    else if (event.key === "Tab") return this.toggle(false);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private async fetch(target: string, extension: string, what: string): Promise<void> {
    const { name, complain } = this.from;
    try {
      const answer = await fetch(target + location.search);
      if (!answer.ok) throw new Error(`${answer.status} ${(await answer.text()).trim()}`);
      download(`${name()}.${extension}`, await answer.blob());
    } catch (error) {
      complain(`${what} could not be had: ${error instanceof Error ? error.message : error}`);
    }
  }

  private tick(seconds: number | null): void {
    this.recording.hidden = seconds === null;
    if (seconds === null || seconds === 0) this.describeVideo();
    if (seconds === null) return;
    const whole = Math.floor(seconds);
    const text = `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
    const label = this.recording.lastElementChild!;
    if (label.textContent === text) return;
    label.textContent = text;
    this.recording.setAttribute("aria-label", `Stop the video, ${text} long`);
  }

  private describeVideo(): void {
    const kind = videoKind();
    const [title, what] = this.recorder.running
      ? ["Stop the video", "and save it"]
      : ["Video", kind ? `of the view, until stopped, ${kind.extension.toUpperCase()}` : "this browser cannot write one"];
    this.video.disabled = kind === null;
    this.video.children[1].textContent = title;
    this.video.children[2].textContent = what;
  }
}
