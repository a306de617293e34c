// Tables: their downloads as CSV, and their layout on narrow screens. The first row of a file contains column names with
// units. Values have all digits, even if the table shows fewer.

function quoted(text) {
  return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

export function csvOf(table) {
  return (
    [...table.rows]
      .map((row) => [...row.cells].map((cell) => quoted(cell.dataset.v ?? cell.textContent.trim())).join(","))
      .join("\n") + "\n"
  );
}

export function addDownloads() {
  for (const table of document.querySelectorAll("table[data-csv]")) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "download";
    button.textContent = "Save as CSV";
    button.setAttribute("aria-label", `Save as CSV: ${table.caption.textContent}`);
    button.addEventListener("click", () => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([csvOf(table)], { type: "text/csv" }));
      link.download = table.dataset.csv;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    });
    table.parentElement.after(button);
  }
}

/** Writes the name of the column into each cell, for tables whose rows are shown as blocks. */
function labelCells(table) {
  const names = [...table.querySelectorAll("thead th")].map((head) => head.textContent);
  for (const row of table.tBodies[0].rows) [...row.cells].forEach((cell, k) => (cell.dataset.label = names[k]));
}

/** Chooses the layout in which the complete width of a table is visible: normal, compact, or rows as blocks. */
function fit(box) {
  const isCut = () => box.scrollWidth > box.clientWidth;
  box.classList.remove("compact", "stacked");
  if (!isCut()) return;
  box.classList.add("compact");
  if (!isCut()) return;
  box.classList.replace("compact", "stacked");
  const cell = box.querySelector("td");
  if (cell && cell.dataset.label == null) labelCells(box.querySelector("table"));
}

/** Fits all tables to the width of the page, and again when the width changes. */
export function fitTables() {
  const widths = new Map();
  const observer = new ResizeObserver((entries) => {
    for (const { target } of entries) {
      if (widths.get(target) === target.offsetWidth) continue;
      widths.set(target, target.offsetWidth);
      fit(target);
    }
  });
  for (const table of document.querySelectorAll("table[data-csv]")) observer.observe(table.parentElement);
}
