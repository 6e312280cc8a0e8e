/* What the page says in words: lists of sentences, tables, figures, and commands. */

import { own } from "./controls.js";
import { word } from "./glossary.js";

const made = (name, ...content) => {
  const element = document.createElement(name);
  element.append(...content);
  return element;
};

/* Puts sentences into a list, which is hidden if there are none, and counts them. */
export function list(id, sentences) {
  const element = document.getElementById(id);
  element.replaceChildren(...sentences.map(text => made("li", own(text))));
  element.hidden = !sentences.length;
  return sentences.length;
}

/* Puts rows, of a name and a text, into a table. */
export function table(id, rows) {
  const row = ([name, text]) => {
    const head = made("th", word(name));
    head.scope = "row";
    return made("tr", head, made("td", own(text)));
  };
  document.getElementById(id).replaceChildren(...rows.map(row));
}

/* A figure under its name. */
export const figure = (name, content) => {
  const text = made("dd", content);
  // a long one is cut off
  text.title = text.textContent;
  return made("div", made("dt", word(name)), text);
};

/* A command on lines of some eighty characters; one with quoted words stays as it is. */
export function folded(command) {
  if (/['"\\]/.test(command)) return command;
  return command.split(/ (?=--)/).reduce((lines, option) => {
    const before = lines.slice(lines.lastIndexOf("\n") + 1);
    return before.length + option.length > 78 ? `${lines} \\\n    ${option}` : `${lines} ${option}`;
  });
}
