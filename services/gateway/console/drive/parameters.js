// Fields for the parameters of a kind of mission, from their JSON Schema.

import { html } from "../page/dom.js";

/** The plain type of a parameter that may also be left out. */
const typeOf = (schema) => schema.type || schema.anyOf?.map((one) => one.type).find((type) => type !== "null") || "string";

const UNITS = { m: "m", s: "s", rad: "rad", deg: "°" };

/** What a field is called: its title, or the words of its name with the unit in brackets. */
function caption(name, title) {
  const words = name.split("_");
  const made = words.map((word) => word[0].toUpperCase() + word.slice(1)).join(" "); // as pydantic makes a title
  if (title && title !== made) return title;
  const unit = words.length > 1 ? UNITS[words.at(-1)] : undefined;
  const text = (unit ? words.slice(0, -1) : words).join(" ");
  return `${text[0].toUpperCase()}${text.slice(1)}${unit ? ` (${unit})` : ""}`;
}

/** One labelled field. */
export function field(name, schema) {
  const type = typeOf(schema);
  const start = schema.default ?? "";
  const title = schema.description || "";
  let input;
  if (schema.enum) input = html("select", { name, title }, ...schema.enum.map((value) => html("option", { value }, value)));
  else if (type === "boolean") input = html("input", { name, title, type: "checkbox" });
  else if (type === "integer" || type === "number") {
    input = html("input", { name, title, type: "number", step: type === "integer" ? 1 : "any", value: start });
  } else input = html("input", { name, title, value: start, maxlength: 400 });
  if (type === "boolean") input.checked = Boolean(schema.default);
  input.dataset.type = type;
  return html("label", {}, `${caption(name, schema.title)} `, input);
}

/** What stands in the fields; empty ones are left to their defaults. */
export function values(fields) {
  const given = {};
  for (const input of fields.querySelectorAll("input, select")) {
    const { type } = input.dataset;
    if (type === "boolean") given[input.name] = input.checked;
    else if (input.value.trim() === "") continue;
    else if (type === "integer" || type === "number") given[input.name] = Number(input.value);
    else if (type === "array") given[input.name] = input.value.split(",").map((part) => part.trim());
    else given[input.name] = input.value;
  }
  return given;
}
