// The icons of the tools: strokes on a square of 20 by 20, in the colour of the text beside them.

const SVG = "http://www.w3.org/2000/svg";
/** The strokes of each icon. */
const STROKES = {
  line: "M4.5 15.5 15.5 4.5 M4.5 13.5a2 2 0 1 1 0 4a2 2 0 1 1 0-4 M15.5 2.5a2 2 0 1 1 0 4a2 2 0 1 1 0-4",
  select: "M3 6V3h3 M9 3h2 M14 3h3v3 M17 9v2 M17 14v3h-3 M11 17H9 M6 17H3v-3 M3 11V9",
  basin: "M3 3h14v14H3z M3 12c3-6 5 3 8-2s3-6 6-5 M6.5 15h.01 M12.5 6h.01",
  in: "M8.5 3.5a5 5 0 1 1 0 10a5 5 0 1 1 0-10 M12.2 12.2 17 17 M8.5 6v5 M6 8.5h5",
  out: "M8.5 3.5a5 5 0 1 1 0 10a5 5 0 1 1 0-10 M12.2 12.2 17 17 M6 8.5h5",
  whole: "M3 7V3h4 M13 3h4v4 M17 13v4h-4 M7 17H3v-4 M7.5 7.5h5v5h-5z",
  between: "M3 7h14 M3 13h14 M7 3v14 M13 3v14 M10 8.6a1.4 1.4 0 1 1 0 2.8a1.4 1.4 0 1 1 0-2.8",
  special: "M3 16C6 5 9 14 17 4 M10 6.8 13 12H7z",
  colours: "M3 4h14v3H3z M3 8.5h14v3H3z M3 13h14v3H3z M7 4v3 M13 8.5v3 M9 13v3",
  units: "M2.5 7h15v6h-15z M5.5 7v3 M8.5 7v2 M11.5 7v3 M14.5 7v2",
  save: "M10 3v9 M6.5 8.5 10 12l3.5-3.5 M3.5 13.5v3h13v-3",
  undo: "M7.5 4 4 7.5 7.5 11 M4 7.5h7.5a4.5 4.5 0 0 1 0 9H8",
  redo: "M12.5 4 16 7.5 12.5 11 M16 7.5H8.5a4.5 4.5 0 0 0 0 9H12",
  pin: "M7 3h6l-1 5 3 3H5l3-3z M10 11v6",
  motion: "M2.5 10c2-8 4-8 6 0s4 8 6 0q1.2-5 3-5",
};

/** An icon by its name. */
export function icon(name) {
  const made = document.createElementNS(SVG, "svg"), path = document.createElementNS(SVG, "path");
  for (const [key, value] of Object.entries({ viewBox: "0 0 20 20", class: "icon", "aria-hidden": "true", focusable: "false" })) made.setAttribute(key, value);
  path.setAttribute("d", STROKES[name]);
  made.append(path);
  return made;
}

/** Puts their icons before the words of the tools in the document. */
export function decorate() {
  for (const tool of document.querySelectorAll("[data-icon]")) {
    if (tool.localName === "button") {
      const words = document.createElement("span");
      words.className = "words";
      words.append(...tool.childNodes);
      tool.append(words);
    }
    tool.prepend(icon(tool.dataset.icon));
  }
}
