// Small builders for HTML and SVG. Text is always set as text: names and reasons come from outside.

export const $ = (id) => document.getElementById(id);

export function html(tag, attributes = {}, ...children) {
  return build(document.createElement(tag), attributes, children);
}

export function svg(tag, attributes = {}, ...children) {
  return build(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
}

function build(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value !== undefined && value !== null && value !== false) element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** Load a classic script once. */
export function script(src) {
  const known = document.querySelector(`script[src="${src}"]`);
  if (known?.dataset.loaded) return Promise.resolve();
  const element = known || html("script", { src });
  const done = new Promise((resolve, reject) => {
    element.addEventListener("load", () => { element.dataset.loaded = "yes"; resolve(); });
    element.addEventListener("error", () => reject(new Error(`${src} does not load`)));
  });
  if (!known) document.head.append(element);
  return done;
}

/** Load a style sheet once. */
export function style(href) {
  if (!document.querySelector(`link[href="${href}"]`)) document.head.append(html("link", { rel: "stylesheet", href }));
}

/** A table with its head. Rows are arrays of texts or elements. */
export function table(titles, rows, attributes = {}) {
  const head = titles.map((title) => html("th", { scope: "col" }, title));
  const body = rows.map((row) => html("tr", {}, ...row.map((cell) => html("td", {}, cell))));
  return html("table", attributes, html("thead", {}, html("tr", {}, ...head)), html("tbody", {}, ...body));
}

export const degrees = (rad) => (rad === null || rad === undefined ? "–" : `${Math.round((rad * 180) / Math.PI)}°`);

/** Which way a heading points, in words; counter-clockwise is left. */
export function side(rad) {
  if (rad === null || rad === undefined) return "unknown";
  const turn = Math.round((Math.atan2(Math.sin(rad), Math.cos(rad)) * 180) / Math.PI);
  if (Math.abs(turn) <= 5) return "ahead";
  if (Math.abs(turn) >= 175) return "behind";
  return `${Math.abs(turn)}° ${turn > 0 ? "left" : "right"}`;
}
