// Signing in with a token, dark and light, help.
import { onUnauthorized, setToken, token } from "./api/client";
import { button, field, h } from "./dom";
import { keys } from "./keyboard";

const themeKey = "slipway-theme";

export function signIn(retry: () => void): { open: () => void; button: HTMLElement } {
  const input = h("input", { type: "password", autocomplete: "off", spellcheck: "false" });
  const close = () => dialog.close();
  const dialog = h(
    "dialog",
    { "aria-labelledby": "sign-in-title" },
    h("form", { method: "dialog", onsubmit: (event) => {
      event.preventDefault();
      setToken(input.value.trim());
      input.value = "";
      name();
      close();
      retry();
    } },
      h("h2", { id: "sign-in-title" }, "Sign in"),
      h("p", {}, "This service asks for a token. Its operator makes one with slipway token NAME. It is kept until this tab is closed."),
      field("Token", input),
      h("div", { class: "row" }, h("button", { class: "primary" }, "Sign in"), button("Not now", close, { class: "quiet" })),
    ),
  );
  document.body.append(dialog);
  const open = () => {
    if (!dialog.open) dialog.showModal();
  };
  const press = button("", () => {
    if (token()) {
      setToken("");
      name();
      retry();
    } else open();
  }, { class: "quiet" });
  // A service without tokens asks for none: then there is nothing to sign in to.
  const name = () => {
    press.textContent = token() ? "Sign out" : "Sign in";
    press.hidden = !asked && !token();
  };
  let asked = false;
  name();
  onUnauthorized(() => {
    asked = true;
    name();
    open();
  });
  return { open, button: press };
}

export function theme(redraw: () => void): HTMLElement {
  const apply = (value: string) => {
    if (value) document.documentElement.dataset.theme = value;
    else delete document.documentElement.dataset.theme;
  };
  apply(localStorage.getItem(themeKey) ?? "");
  const isDark = () => document.documentElement.dataset.theme === "dark" || (!document.documentElement.dataset.theme && matchMedia("(prefers-color-scheme: dark)").matches);
  const press = button("", () => {
    const next = isDark() ? "light" : "dark";
    localStorage.setItem(themeKey, next);
    apply(next);
    name();
    redraw();
  }, { class: "quiet" });
  const name = () => (press.textContent = isDark() ? "Light" : "Dark");
  name();
  return press;
}

export function help(): { open: () => void; button: HTMLElement } {
  const dialog = h(
    "dialog",
    { "aria-labelledby": "help-title" },
    h("h2", { id: "help-title" }, "Keys"),
    h("dl", { class: "keys" }, keys.flatMap(([key, what]) => [h("dt", {}, key), h("dd", {}, what)])),
    button("Close", () => dialog.close(), { class: "primary" }),
  );
  document.body.append(dialog);
  const open = () => dialog.showModal();
  return { open, button: button("Keys", open, { class: "quiet" }) };
}
