// Tables that sort by a press on a heading, and a button that copies each as tab-separated values.

/** The number that a cell holds; NaN where none is known. */
function number(cell) {
  const told = cell.dataset.value ?? cell.textContent.replace("\u2212", "-").replace(/[\s\u00a0]/g, "");
  return told === "" ? NaN : Number(told);
}

/** How two cells of a column follow each other: unknown values last, whichever comes first else. */
function compared(left, right, isNumber, sign) {
  if (!isNumber) {
    const [a, b] = [left.textContent, right.textContent];
    if (a === "" || b === "") return (a === "") - (b === "");
    return sign * a.localeCompare(b, "en", { numeric: true });
  }
  const [a, b] = [number(left), number(right)];
  if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
  return sign * (a - b);
}

/** Rising, then falling, then as it was written. */
const NEXT = { none: "ascending", ascending: "descending", descending: "none" };

function sort(table, rows, column) {
  const headings = [...table.tHead.rows[0].cells];
  const order = NEXT[headings[column].ariaSort ?? "none"];
  for (const it of headings) it.ariaSort = it === headings[column] ? order : "none";
  const isNumber = !headings[column].classList.contains("text");
  const sign = order === "descending" ? -1 : 1;
  const sorted = order === "none" ? rows : rows.toSorted((a, b) => compared(a.cells[column], b.cells[column], isNumber, sign));
  table.tBodies[0].append(...sorted);
}

/** The rows in the order shown; numbers as programs read them. */
function copied(table) {
  const text = (cell) => cell.textContent.trim().replaceAll("\u2212", "-").replaceAll("\u00a0", " ").replace(/^(\d{1,3})( \d{3})+$/, (it) => it.replaceAll(" ", ""));
  return [...table.rows].map((row) => [...row.cells].map(text).join("\t")).join("\n") + "\n";
}

/** Copies as pages do that the browser lets, and else as older ones do. */
async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const field = document.createElement("textarea");
    field.value = text;
    document.body.append(field);
    field.select();
    const done = document.execCommand("copy");
    field.remove();
    if (!done) throw new Error("not copied");
  }
}

// What was done, for those who hear it.
const status = document.createElement("div");
status.className = "heard";
status.setAttribute("role", "status");
document.querySelector("main").append(status);

for (const part of document.querySelectorAll(".table")) {
  const table = part.querySelector("table");
  const rows = [...table.tBodies[0].rows];
  if (rows.length > 1) {
    for (const [column, heading] of [...table.tHead.rows[0].cells].entries()) {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...heading.childNodes);
      heading.append(button);
      heading.ariaSort = "none";
      button.addEventListener("click", () => sort(table, rows, column));
    }
  }
  const button = document.createElement("button");
  button.type = "button";
  button.className = "copy";
  button.textContent = "Copy table";
  const name = part.querySelector(".caption b").textContent.replace(/\.$/, "");
  button.setAttribute("aria-label", `Copy ${name} as tab-separated values`);
  button.addEventListener("click", async () => {
    const shown = await copy(copied(table)).then(() => "Copied", () => "Not copied");
    button.textContent = shown;
    status.textContent = `${name}: ${shown.toLowerCase()}`;
    setTimeout(() => { button.textContent = "Copy table"; }, 2000);
  });
  part.querySelector(".head").append(button);
  // What scrolls can be reached by keys.
  const wide = part.querySelector(".wide");
  const reach = () => { wide.tabIndex = wide.scrollWidth > wide.clientWidth ? 0 : -1; };
  addEventListener("resize", reach);
  reach();
}
