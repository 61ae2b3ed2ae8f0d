// Rows and sections of the panel.
import { h } from "./dom";

let selects = 0;

export function select(label: string, options: [string, string][]): { row: HTMLElement; input: HTMLSelectElement } {
  const id = `select-${++selects}`;
  const input = h("select", { id });
  fill(input, options);
  return { row: h("div", { class: "row select" }, h("label", { for: id }, label), input), input };
}

export function fill(input: HTMLSelectElement, options: [string, string][]): void {
  const now = [...input.options].map((o) => [o.value, o.text].join()).join();
  if (now === options.map((o) => o.join()).join()) return;
  const value = input.value;
  input.replaceChildren(...options.map(([v, text]) => h("option", { value: v }, text)));
  if (options.some(([v]) => v === value)) input.value = value;
}

export function section(title: string, ...rows: HTMLElement[]): HTMLElement {
  return h("details", { open: true }, h("summary", {}, title), ...rows);
}
