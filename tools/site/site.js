// Formulas: arithmatex leaves \( \) and \[ \] for KaTeX.
document.addEventListener("DOMContentLoaded", () => renderMathInElement(document.body, {
  delimiters: [{ left: "\\(", right: "\\)", display: false }, { left: "\\[", right: "\\]", display: true }],
}));
