// Small helpers for building the page.

type Attributes = Record<string, string | number | boolean>;

/** An element with attributes and children. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === true) element.setAttribute(name, "");
    else if (value !== false) element.setAttribute(name, String(value));
  }
  element.append(...children);
  return element;
}

const ICONS: Record<string, string> = {
  play: "M8 5.5v13l11-6.5z",
  pause: "M7 5h3.6v14H7zM13.4 5H17v14h-3.6z",
  step: "M6 5.5v13l9-6.5zM16 5.5h2.6v13H16z",
  reset: "M12 5a7 7 0 1 1-6.6 9.3l1.9-.7A5 5 0 1 0 12 7v3L7.4 6.2 12 2.5z",
  pull: "M9 11V5.5a1.5 1.5 0 0 1 3 0V10h.6V7a1.4 1.4 0 0 1 2.8 0v3.4h.5V8.6a1.3 1.3 0 0 1 2.6 0V15c0 3.4-2.2 5.5-5.4 5.5-2.7 0-4.1-1.2-5.3-3.3L5 12.9c-.8-1.5 1.2-2.7 2.3-1.4z",
  pin: "M12 3a5.5 5.5 0 0 1 5.5 5.5c0 4-5.5 12-5.5 12s-5.5-8-5.5-12A5.5 5.5 0 0 1 12 3zm0 3.4a2.1 2.1 0 1 0 0 4.2 2.1 2.1 0 0 0 0-4.2z",
  ball: "M13 3.5a6.5 6.5 0 1 1 0 13 6.5 6.5 0 0 1 0-13zm-2.2 2.7a4.2 4.2 0 0 0-2 2.6l1.5.5a2.6 2.6 0 0 1 1.3-1.7zM3 15.2c2.6.3 4 1.5 5.4 2.6 1.5 1.2 3 2.3 5.9 2.3 2.6 0 4.7-.8 6.7-2.2v2.3c-2 1.1-4.2 1.7-6.7 1.7-3.6 0-5.6-1.4-7.2-2.7-1.3-1-2.3-1.8-4.1-2z",
  scalpel: "M20.6 3.2c.6 2.3-.3 4.7-2.300 6.700L12.600 15.600 8.400 11.400zM7.200 12.600l4.200 4.200-1.500 1.500-1.900-.500-3.800 3.300-1.400-1.400 3.300-3.800-.400-1.800z",
  undo: "M9 6.2V3L3.500 8.300 9 13.600v-3.400h4.300a3.700 3.700 0 0 1 0 7.400H7.500v2.400h5.800a6.100 6.100 0 0 0 0-12.200H9z",
  redo: "M15 6.200V3l5.500 5.300-5.500 5.300v-3.400h-4.300a3.700 3.700 0 0 0 0 7.400h5.800v2.400h-5.800a6.100 6.100 0 0 1 0-12.200H15z",
  options: "M12 5c4.6 0 8.3 2.7 10 7-1.7 4.3-5.4 7-10 7S3.7 16.3 2 12c1.7-4.3 5.4-7 10-7zm0 2c-3.4 0-6.2 1.8-7.8 5 1.6 3.2 4.4 5 7.8 5s6.2-1.8 7.8-5c-1.6-3.2-4.4-5-7.8-5zm0 1.700a3.3 3.3 0 1 1 0 6.6 3.3 3.3 0 0 1 0-6.600z",
  flip: "M8 5v3h12v2H8v3L3.5 9zm8 6v3H4v2h12v3l4.5-4z",
  panel: "M4 6h9v2H4zm13 0h3v2h-3zM14 4h2v6h-2zM4 11h3v2H4zm7 0h9v2h-9zM8 9h2v6H8zM4 16h9v2H4zm13 0h3v2h-3zm-3-2h2v6h-2z",
  help: "M12 3a9 9 0 1 1 0 18 9 9 0 0 1 0-18zm0 2a7 7 0 1 0 0 14 7 7 0 0 0 0-14zm-1 10.2h2v2h-2zm1-8.4c2 0 3.5 1.3 3.5 3 0 1.9-2 2.3-2.4 3.6l-.1.6h-2c0-2.3 2.3-2.7 2.3-4 0-.7-.6-1.2-1.4-1.2-.9 0-1.5.6-1.6 1.5H8.4c.1-2.1 1.6-3.5 3.6-3.5z",
  camera: "M9 5h6l1.4 2H20v12H4V7h3.6zm3 3.6a4.2 4.2 0 1 0 0 8.4 4.2 4.2 0 0 0 0-8.4zm0 2a2.2 2.2 0 1 1 0 4.4 2.2 2.2 0 0 1 0-4.4z",
  file: "M6 3h8l4 4v14H6zm7 1.8V8h3.2zM8 11v1.6h8V11zm0 3.4V16h8v-1.6z",
  plot: "M4 4h2v14h14v2H4zM8.2 16.2 7 14.7l4.3-5.6 3 2.5L18.6 6l1.5 1.2-5.4 7.2-3-2.6z",
  save: "M11 4h2v7.2l2.6-2.6L17 10l-5 5-5-5 1.4-1.4 2.6 2.6zM5 17h14v2.4H5z",
  scenes: "M4 5h7v6.2H4zm9 0h7v6.2h-7zM4 13h7v6.2H4zm9 0h7v6.2h-7z",
  video: "M4 6.5h11.5V10L20 7v10l-4.5-3v3.5H4z",
  mesh: "M12 3 21.8 20.5H2.2zm0 4.6-2.6 4.6h5.2zm-3.7 6.5-2.6 4.6h5.2zm7.4 0-2.6 4.6h5.2zm-5.4 0L12 17l1.7-2.9z",
  close: "M6.4 5 12 10.6 17.6 5 19 6.4 13.4 12 19 17.6 17.6 19 12 13.4 6.4 19 5 17.6 10.6 12 5 6.4z",
  home: "M12 4 3.5 11h2.3v8.5h4.7v-5.3h3v5.3h4.7V11h2.3z",
};

export function icon(name: keyof typeof ICONS | string): SVGSVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  path.setAttribute("d", ICONS[name] ?? "");
  path.setAttribute("fill-rule", "evenodd");
  svg.append(path);
  return svg;
}

/** A button with an icon, its name for screen readers and its key in the hint. */
export function iconButton(name: string, label: string, key: string, act: () => void): HTMLButtonElement {
  const button = h("button", {
    class: "icon",
    type: "button",
    "aria-label": label,
    title: key ? `${label} (${key})` : label,
  });
  button.append(icon(name));
  button.addEventListener("click", act);
  return button;
}

export function setIcon(button: HTMLButtonElement, name: string, label: string, key: string): void {
  if (button.getAttribute("aria-label") === label) return;
  button.replaceChildren(icon(name));
  button.setAttribute("aria-label", label);
  button.title = `${label} (${key})`;
}

/** Saves a text or picture as a file. */
export function download(name: string, content: Blob): void {
  const link = h("a", { href: URL.createObjectURL(content), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
