// The contents stand open where there is room for them next to the text.
document.querySelector("nav details").open = matchMedia("(min-width: 76rem)").matches;

// Every table can be saved as CSV, and every figure as SVG: what the page holds, and nothing from elsewhere.
for (const figure of document.querySelectorAll("figure")) {
  const table = figure.querySelector("table");
  const drawing = figure.querySelector(":scope > svg, .parts svg:last-child");
  const name = figure.querySelector(".number").textContent.toLowerCase().replace(/\W+/g, "-").replace(/-$/, "");
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = table ? "CSV" : "SVG";
  button.title = "Save " + name;
  button.addEventListener("click", () => {
    const [text, type] = table ? [asCsv(table), "text/csv"] : [asSvg(drawing), "image/svg+xml"];
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type }));
    link.download = name + (table ? ".csv" : ".svg");
    link.click();
    URL.revokeObjectURL(link.href);
  });
  figure.querySelector("figcaption").append(button);
}

// Blocks that move, drawn when they come into sight; without script, and on paper, the drawing stands.
const sight = new IntersectionObserver((entries) => {
  for (const entry of entries.filter((one) => one.isIntersecting)) {
    sight.unobserve(entry.target);
    entry.target.classList.add("drawn");
    showMoving(entry.target.querySelector(".moving"), JSON.parse(entry.target.querySelector("script").textContent));
  }
}, { rootMargin: "600px" });
for (const place of document.querySelectorAll(".moving")) sight.observe(place.parentElement);

function asCsv(table) {
  const quoted = (cell) => '"' + cell.textContent.trim().replaceAll('"', '""') + '"';
  return [...table.rows].map((row) => [...row.cells].map(quoted).join(",")).join("\r\n") + "\r\n";
}

function asSvg(drawing) {
  return '<?xml version="1.0" encoding="UTF-8"?>\n' + new XMLSerializer().serializeToString(drawing);
}
