// Requests to the gateway: one place for the token and for problem documents.

import { TEXT } from "./text.js";

const TOKEN = "topnav-token";
const AUTHOR = "console";

export class Problem extends Error {
  constructor(status, body) {
    super(body.detail || `status ${status}`);
    this.status = status;
    this.body = body;
  }
}

/** Ask for a token in a dialog; resolves to whether one was given. */
function askForToken() {
  const dialog = document.getElementById("token-dialog");
  dialog.returnValue = "";
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => {
      const token = document.getElementById("token").value;
      if (dialog.returnValue === "ok" && token) sessionStorage.setItem(TOKEN, token);
      resolve(dialog.returnValue === "ok" && Boolean(token));
    }, { once: true });
  });
}

async function send(method, path, body, type) {
  const headers = method === "GET" ? {} : { "X-Topnav-Author": AUTHOR };
  const token = sessionStorage.getItem(TOKEN);
  if (token) headers.Authorization = `Bearer ${token}`;
  if (type) headers["Content-Type"] = type;
  return fetch(path, { method, headers, body, cache: "no-store" });
}

/** Send a request and return its JSON; throws Problem for errors of the gateway. */
export async function call(method, path, body, type) {
  let answer;
  try {
    answer = await send(method, path, body, type);
    if (answer.status === 401 && (await askForToken())) answer = await send(method, path, body, type);
  } catch {
    throw new Problem(0, { detail: TEXT.gatewaySilent });
  }
  const text = await answer.text();
  let content = {};
  try {
    content = text ? JSON.parse(text) : {};
  } catch {
    content = { detail: `status ${answer.status}` };
  }
  if (!answer.ok) throw new Problem(answer.status, content);
  return content;
}

export const get = (path) => call("GET", path);
export const post = (path, content) =>
  content === undefined ? call("POST", path) : call("POST", path, JSON.stringify(content), "application/json");
export const upload = (path, file) => call("POST", path, file, file.type || "application/octet-stream");
