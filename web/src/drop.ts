// Files dropped anywhere on the page.
import { h } from "./dom";

const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;

export class DropZone {
  readonly element = h("div", { id: "drop", "aria-hidden": "true", hidden: true },
    h("p", {}, h("b", {}, "Drop to open"), "a scene with its meshes, or a mesh alone"));

  constructor(take: (files: File[]) => void) {
    const over = (event: DragEvent) => {
      if (!hasFiles(event)) return;
      event.preventDefault(); // otherwise the browser would open the file
      event.dataTransfer!.dropEffect = "copy";
      this.show(true);
    };
    window.addEventListener("dragenter", over);
    window.addEventListener("dragover", over);
    window.addEventListener("dragleave", (event) => event.relatedTarget === null && this.show(false));
    window.addEventListener("drop", (event) => {
      if (!hasFiles(event)) return;
      event.preventDefault();
      this.show(false);
      take([...event.dataTransfer!.files]);
    });
  }

  private show(is: boolean): void {
    this.element.hidden = !is;
    document.body.classList.toggle("dropping", is);
  }
}
