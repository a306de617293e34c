// Downloads of tables as CSV. The first row contains column names with units. Values have all digits, even if the table
// shows fewer.

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
