// Who sits here: the token of this tab, and the cookie with which the page reads pictures and opens its WebSocket.

import { $ } from "./dom.js";
import { TEXT } from "./text.js";

const TOKEN = "topnav-token";

let asking = null; // one dialog at a time, whoever asks
let declined = false; // what the page fetches by itself does not ask again

export const token = () => sessionStorage.getItem(TOKEN) || "";

/** Whether reading was refused when last tried. */
export let locked = false;

const session = (method, secret) =>
  fetch("/api/session", { method, headers: secret ? { Authorization: `Bearer ${secret}` } : {}, cache: "no-store" });

/** Get a session cookie, and show who sits here; resolves to whether this page may read. */
export async function enter() {
  try {
    let answer = token() ? await session("POST", token()) : await session("GET");
    if (answer.status === 401 && token()) answer = await session("GET");
    locked = answer.status === 401;
    if (answer.ok) show(await answer.json());
    else if (locked) show({ guarded: true, role: null });
  } catch {
    return true; // the gateway is silent: the WebSocket finds out and says so
  }
  return !locked;
}

/** A request with the token `sent` was not let in: resolves to whether another is worth a try. */
export async function another(sent, method) {
  if (token() !== sent) return true; // somebody was quicker
  if (method === "GET" && declined) return false;
  return ask(sent ? TEXT.tokenRefused : "");
}

function ask(why) {
  asking ??= open(why).finally(() => { asking = null; });
  return asking;
}

function open(why) {
  const dialog = $("token-dialog");
  dialog.returnValue = "";
  $("token").value = "";
  $("token-said").textContent = why;
  $("token-forget").hidden = !token();
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => resolve(take(dialog.returnValue, $("token").value.trim())), { once: true });
  });
}

async function take(answer, secret) {
  declined = answer !== "ok" || !secret;
  if (answer === "forget") await forget();
  if (declined) return false;
  sessionStorage.setItem(TOKEN, secret);
  await enter();
  return true;
}

async function forget() {
  await session("DELETE", token()).catch(() => null);
  sessionStorage.removeItem(TOKEN);
  location.reload();
}

function show({ guarded, name, role }) {
  $("identity").hidden = !guarded;
  $("identity").textContent = role ? TEXT.identity(name, role) : TEXT.enterToken;
}

$("identity").addEventListener("click", async () => {
  if (await ask("")) location.reload();
});
