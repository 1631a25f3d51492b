// Requests to the gateway, with the token of this tab; its problem documents as errors.

import { another, token } from "./session.js";
import { TEXT } from "./text.js";

const AUTHOR = "console";
const ROLE_TOO_LOW = "urn:topnav:problem:role_too_low";

export class Problem extends Error {
  constructor(status, body) {
    super(body.type === ROLE_TOO_LOW ? TEXT.roleTooLow(body) : body.detail || `status ${status}`);
    this.status = status;
    this.body = body;
  }
}

async function send(method, path, body, type, secret) {
  const headers = method === "GET" ? {} : { "X-Topnav-Author": AUTHOR };
  if (secret) headers.Authorization = `Bearer ${secret}`;
  if (type) headers["Content-Type"] = type;
  return fetch(path, { method, headers, body, cache: "no-store" });
}

/** Send a request and return its JSON; throws Problem for errors of the gateway. */
export async function call(method, path, body, type) {
  let answer;
  try {
    const secret = token();
    answer = await send(method, path, body, type, secret);
    if (answer.status === 401 && (await another(secret, method))) answer = await send(method, path, body, type, token());
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
