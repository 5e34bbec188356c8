"use strict";
// Tables: a click (or Enter) on a head sorts by that column, again the other way round. Numbers sort as numbers.
for (const head of document.querySelectorAll(".heads th")) {
  const sort = () => {
    const table = head.closest("table"), body = table.tBodies[0], column = head.cellIndex;
    const up = head.getAttribute("aria-sort") !== "ascending";
    for (const other of head.parentNode.cells) other.setAttribute("aria-sort", "none");
    head.setAttribute("aria-sort", up ? "ascending" : "descending");
    const key = (row) => {
      const cell = row.cells[column];
      return cell.dataset.sort === undefined ? cell.textContent.trim() : Number(cell.dataset.sort);
    };
    const missing = (k) => typeof k === "string" && (k === "" || k === "-");
    const rows = [...body.rows].map((row) => [key(row), row]);
    rows.sort(([a], [b]) => {
      if (missing(a) || missing(b)) return missing(a) - missing(b);
      const order = typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), "en", { numeric: true });
      return up ? order : -order;
    });
    body.append(...rows.map(([, row]) => row));
  };
  head.addEventListener("click", sort);
  head.addEventListener("keydown", (event) => { if (event.key === "Enter") sort(); });
}
// Links lead to headings below the row of links, which stays in sight and has as many lines as the window makes of it.
const nav = document.querySelector("nav");
const measure = () => document.documentElement.style.setProperty("--nav", `${nav.offsetHeight}px`);
new ResizeObserver(measure).observe(nav);
measure();
// A link to a folded section opens it.
const unfold = () => {
  const section = location.hash.length > 1 && document.getElementById(location.hash.slice(1));
  const details = section && section.querySelector("details");
  if (details) details.open = true;
};
addEventListener("hashchange", unfold);
unfold();
// Curves: the values of all curves at the pointer.
const tip = document.getElementById("tip");
const digits = (v) => Math.abs(v) >= 1000 ? v.toFixed(0) : Math.abs(v) >= 100 ? v.toFixed(1) : v.toFixed(Math.abs(v) >= 1 ? 2 : 4);
const frames = (v) => v >= 1e6 ? (v / 1e6).toFixed(2) + "M" : v >= 1e3 ? (v / 1e3).toFixed(1) + "k" : v.toFixed(0);
for (const plot of document.querySelectorAll("rect.hover")) {
  const values = JSON.parse(plot.dataset.values);
  let line = null;
  plot.addEventListener("pointermove", (event) => {
    const box = plot.getBoundingClientRect();
    const at = values.from + (values.to - values.from) * (event.clientX - box.left) / box.width;
    tip.replaceChildren();
    const head = document.createElement("b");
    head.textContent = (values.axis === "frames" ? frames(at) : digits(at)) + " " + values.axis;
    tip.append(head);
    for (const curve of values.curves) {
      if (!curve.points.length || at > curve.points[curve.points.length - 1][0] * 1.01) continue;
      let nearest = curve.points[0];
      for (const point of curve.points) if (Math.abs(point[0] - at) < Math.abs(nearest[0] - at)) nearest = point;
      const row = document.createElement("div"), mark = document.createElement("i");
      mark.style.background = `var(--${curve.ink})`;
      const half = nearest[2] === null ? "" : " ± " + digits(nearest[2]);
      row.append(mark, `${curve.name}  ${digits(nearest[1])}${half}  n=${nearest[3]}`);
      tip.append(row);
    }
    tip.hidden = false;
    const right = event.clientX + 20 + tip.offsetWidth > document.documentElement.clientWidth;
    tip.style.left = event.pageX + (right ? -16 - tip.offsetWidth : 16) + "px";
    tip.style.top = event.pageY + 14 + "px";
    if (!line) {
      line = document.createElementNS("http://www.w3.org/2000/svg", "line");
      line.setAttribute("class", "pointer");
      plot.parentNode.append(line);
    }
    const x = Number(plot.getAttribute("x")) + Number(plot.getAttribute("width")) * (event.clientX - box.left) / box.width;
    const y = Number(plot.getAttribute("y"));
    line.setAttribute("x1", x);
    line.setAttribute("x2", x);
    line.setAttribute("y1", y);
    line.setAttribute("y2", y + Number(plot.getAttribute("height")));
  });
  plot.addEventListener("pointerleave", () => {
    tip.hidden = true;
    if (line) line.remove();
    line = null;
  });
}
