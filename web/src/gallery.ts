// The scenes that come with Sinew, as cards; own files too.
import { h, icon, iconButton } from "./dom";
import { MESHES, SCENE } from "./files";
import "./gallery.css";

interface Entry {
  name: string;
  title: string;
  look_for: string;
  picture: string | null;
}

export interface GalleryActions {
  open(entry: { name: string; title: string }): void;
  files(files: File[]): void;
  takeControls(): void;
}

export class Gallery {
  readonly element: HTMLDialogElement;
  readonly button: HTMLButtonElement;
  private readonly cards = h("div", { class: "cards" });
  private readonly watching: HTMLElement;
  private readonly choose = h("button", { type: "button", class: "text" }, "Open a file …");
  private current = "";
  private asked = false;

  constructor(private readonly actions: GalleryActions) {
    this.button = iconButton("scenes", "Scenes", "O", () => this.toggle());
    const input = h("input", { type: "file", multiple: true, hidden: true, accept: [SCENE, ...MESHES].join(), "aria-label": "Files to open" });
    this.choose.addEventListener("click", () => input.click());
    input.addEventListener("change", () => {
      const files = [...(input.files ?? [])];
      input.value = ""; // so that the same file can be chosen again
      if (files.length === 0) return;
      this.element.close();
      actions.files(files);
    });
    const take = h("button", { type: "button", class: "text" }, "Take the controls");
    take.addEventListener("click", () => actions.takeControls());
    this.watching = h("p", { class: "watching-note", role: "status" },
      "Another browser has the controls, so this one cannot choose. ", take);
    this.element = h("dialog", { id: "gallery", "aria-label": "Scenes", "data-key": "o" },
      h("div", { class: "top" }, h("h2", {}, "Scenes"), this.choose, iconButton("close", "Close", "Esc", () => this.element.close())),
      this.watching, this.cards,
      h("p", { class: "own" }, `Your own: drop a scene (${SCENE}) with its meshes, or a mesh alone (${MESHES.join(" ")}), anywhere on the page.`));
    this.element.addEventListener("click", (e) => e.target === this.element && this.element.close());
    this.setControls(false);
  }

  toggle(): void {
    if (this.element.open) this.element.close();
    else this.show();
  }

  show(): void {
    if (!this.element.open) this.element.showModal();
    if (!this.asked) void this.load();
  }

  setControls(has: boolean): void {
    this.watching.hidden = has;
    this.choose.disabled = !has;
    for (const card of this.cards.querySelectorAll("button")) card.disabled = !has;
  }

  /** The scene that is shown, by name. */
  setCurrent(name: string): void {
    this.current = name;
    for (const card of this.cards.querySelectorAll<HTMLElement>(".scene")) {
      card.setAttribute("aria-current", String(card.dataset.name === name));
    }
  }

  private async load(): Promise<void> {
    this.asked = true;
    this.cards.replaceChildren(h("p", { class: "loading" }, "Loading …"));
    try {
      const answer = await fetch(`/gallery.json${location.search}`);
      if (!answer.ok) throw new Error(`${answer.status} ${(await answer.text()).trim()}`);
      const entries = (await answer.json()) as Entry[];
      this.cards.replaceChildren(...entries.map((entry) => this.card(entry)));
      if (entries.length === 0) this.cards.append(h("p", { class: "loading" }, "No scenes are installed with this Sinew."));
    } catch (error) {
      this.asked = false; // requests the list again when it is opened again
      this.cards.replaceChildren(h("p", { class: "loading" }, `The list of scenes could not be had: ${error instanceof Error ? error.message : error}`));
    }
    this.setCurrent(this.current);
    this.setControls(this.watching.hidden);
    if (this.element.open) (this.cards.querySelector<HTMLElement>("[aria-current=true]") ?? this.cards.querySelector<HTMLElement>(".scene"))?.focus();
  }

  private card(entry: Entry): HTMLElement {
    const picture = entry.picture
      ? h("img", { src: entry.picture + location.search, alt: "", width: 480, height: 300, loading: "lazy" })
      : h("div", { class: "no-picture" }, icon("mesh"));
    const card = h("button", { type: "button", class: "scene", "data-name": entry.name },
      picture, h("b", {}, entry.title || entry.name), h("span", { title: entry.look_for }, entry.look_for));
    card.addEventListener("click", () => {
      this.element.close();
      this.actions.open({ name: entry.name, title: entry.title || entry.name });
    });
    return card;
  }
}
