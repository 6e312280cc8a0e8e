/* The names of keys in sentences of the library, in the words of the page's own inputs. */

/* The keys with inputs of other names, and the choice that they are. */
const INPUTS = {
  fill: [["holes"], "fill"],
  absent_missing: [["holes"], "absent"],
  mirror: [["edges"], "mirror"],
  window: [["edges"], "window"],
  accuracy: [["size", "resample"]],
  lengths: [["made_lengths", "lengths"]],
};

/* The text of the input of a key, of several inputs the one that is shown; none without an input. */
function control(key) {
  const name = key.replaceAll("-", "_"),
    [names, choice] = INPUTS[name] ?? [[name]];
  const inputs = names.flatMap(name => [...document.getElementsByName(name)]).filter(input => input.closest("label"));
  const input = inputs.find(({ offsetParent }) => offsetParent) ?? inputs[0];
  if (!input) return undefined;
  const isText = node => node.nodeType === Node.TEXT_NODE || node.className === "word";
  const texts = [...input.closest("label").childNodes].filter(isText).map(({ textContent }) => textContent);
  const chosen = choice ? `: ${[...input.options].find(({ value }) => value === choice).text}` : "";
  return `“${texts.join("").trim()}${chosen}”`;
}

/* A sentence in which keys, options and calls are inputs of the page; options without one are plain words. */
export function own(text) {
  const named = (all, key) => control(key) ?? all;
  return text
    .replace(/\basperity\.\w+\((\w+)=\.\.\.\)/g, named)
    .replace(/(?:\b(?:asperity )?prepare )?--([a-z][a-z-]*)/g, (_, key) => control(key) ?? key.replaceAll("-", " "))
    .replace(/\b([a-z]+(?:_[a-z]+)+)\b(?:=(?:True|'[^']*'))?/g, named)
    .replace(/(?<=\(|\bstep )([a-z]+)\b(?=\)|[;,.]|$| )/g, named);
}
