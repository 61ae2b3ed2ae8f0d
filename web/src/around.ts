// The parts around the 3D view: plots, gallery, files, saving, messages.
import { DropZone } from "./drop";
import { pack, post } from "./files";
import { Gallery } from "./gallery";
import { Hint } from "./hint";
import { Notice } from "./notice";
import { Opening } from "./opening";
import { Plots } from "./plots";
import type { Command, Text } from "./protocol";
import { SaveMenu } from "./save";
import "./around.css";

/** The parts of the view that this file uses. */
export interface Inside {
  canvas: HTMLCanvasElement;
  send(command: Command): boolean;
  picture(done: (png: Blob | null) => void): void;
  draw(): void; // draws again, although nothing has changed
  resized(): void;
}

const WATCHING = "Another browser has the controls: take them to open a file";

export class Around {
  readonly plots: Plots;
  readonly elements: HTMLElement[];
  readonly buttons: HTMLElement[];
  readonly keys: Record<string, () => void>;
  private readonly notice = new Notice();
  private readonly opening = new Opening(() => void this.inside.send({ type: "cancel" }));
  private readonly gallery: Gallery;
  readonly hint: Hint;
  private readonly save: SaveMenu;
  private scene = "sinew";
  private controls = false;
  private ticket = "";
  private greeted = false;
  private sending = false;

  constructor(private readonly inside: Inside) {
    this.plots = new Plots(() => inside.resized());
    this.gallery = new Gallery({
      open: (entry) => this.open({ type: "open", scene: entry.name }, entry.title),
      files: (files) => void this.take(files),
      takeControls: () => inside.send({ type: "control" }),
    });
    this.hint = new Hint(inside.canvas);
    this.save = new SaveMenu({
      name: () => this.scene,
      canvas: inside.canvas,
      history: this.plots.history,
      picture: (done) => inside.picture(done),
      draw: () => inside.draw(),
      complain: (message) => this.complain(message),
    });
    const drop = new DropZone((files) => void this.take(files));
    this.buttons = [this.gallery.button, this.plots.button, this.save.button];
    this.elements = [this.save.element, this.save.recording, this.notice.element, this.opening.element, this.gallery.element, drop.element];
    document.body.append(this.plots.element); // below the rest of the page
    this.keys = {
      d: () => this.plots.toggle(),
      e: () => this.save.toggle(),
      o: () => this.gallery.toggle(),
    };
  }

  hear(message: Text, now: number): void {
    switch (message.type) {
      case "hello":
        if (message.gallery && !this.greeted) this.gallery.show();
        this.greeted = true;
        break;
      case "role":
        this.controls = message.controls;
        this.ticket = message.ticket;
        this.gallery.setControls(message.controls);
        break;
      case "scene":
        this.scene = message.name || "sinew";
        this.plots.showScene(message);
        this.gallery.setCurrent(message.name);
        this.opening.scene(message.opened);
        break;
      case "status":
        if (message.running) this.hint.done();
        this.plots.showStatus(message, now);
    }
  }

  disconnected(): void {
    this.controls = false;
    this.gallery.setControls(false);
    this.opening.end();
  }

  /** Shows an error. An error that prevents a scene from opening stays until it is closed. */
  complain(message: string): void {
    this.notice.show(message, this.opening.pending);
    this.opening.end();
  }

  private open(command: Command, title: string): void {
    this.notice.hide();
    if (this.inside.send(command)) this.opening.begin(title);
  }

  /** Sends files and opens the scene that they form. */
  private async take(files: File[]): Promise<void> {
    if (!this.controls) return this.notice.show(WATCHING);
    if (this.sending) return this.notice.show("Other files are still on their way");
    this.notice.hide();
    this.sending = true;
    try {
      const parcel = pack(files);
      for (const { file, name } of parcel.files) {
        this.opening.sending(file.name, 0);
        await post(file, name, this.ticket, (share) => this.opening.sending(file.name, share));
      }
      this.opening.end();
      this.open({ type: "open", file: parcel.open }, parcel.open);
    } catch (error) {
      this.opening.end();
      this.notice.show(error instanceof Error ? error.message : String(error), true);
    } finally {
      this.sending = false;
    }
  }
}
