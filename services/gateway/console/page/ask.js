// Questions to the person in front: confirm something, or type a name. A dialog of the page, not of the browser.

import { $ } from "./dom.js";

/** Resolves to true when confirmed. */
export function confirmed(question, yes) {
  $("confirm-text").textContent = question;
  $("confirm-yes").textContent = yes;
  return open($("confirm-dialog")).then((answer) => answer === "yes");
}

/** Resolves to the text, or null. `pattern` is what the text must match. */
export async function asked(question, value, hint, yes, pattern = "") {
  $("ask-text").textContent = question;
  $("ask-hint").textContent = hint;
  $("ask-value").value = value;
  $("ask-yes").textContent = yes;
  if (pattern) $("ask-value").pattern = pattern;
  else $("ask-value").removeAttribute("pattern");
  return (await open($("ask-dialog"))) === "yes" ? $("ask-value").value.trim() : null;
}

function open(dialog) {
  dialog.returnValue = "";
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => resolve(dialog.returnValue), { once: true });
  });
}
