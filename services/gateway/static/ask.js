// Questions to the person in front: confirm something, or type a name. A dialog of the page, not of the browser.

import { $ } from "./dom.js";

/** Resolves to true when confirmed. */
export function confirmed(question, yes) {
  $("confirm-text").textContent = question;
  $("confirm-yes").textContent = yes;
  return open($("confirm-dialog")).then((answer) => answer === "yes");
}

/** Resolves to the text, or null. */
export async function asked(question, value, hint) {
  $("ask-text").textContent = question;
  $("ask-hint").textContent = hint;
  $("ask-value").value = value;
  return (await open($("ask-dialog"))) === "yes" ? $("ask-value").value.trim() : null;
}

function open(dialog) {
  dialog.returnValue = "";
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => resolve(dialog.returnValue), { once: true });
  });
}
