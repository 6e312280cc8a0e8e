/* The words of the page: each has a line in the list `words`, with a link to the guide, which is one folder above. */

const words = document.getElementById("words");
const lines = new Map([...words.querySelectorAll("dt")].map(word => [word.textContent, word.nextElementSibling]));

/* A text, which tells its line if it has one. */
export function word(text) {
  const line = lines.get(text.trim());
  if (!line) return text;
  const made = document.createElement("span");
  Object.assign(made, {
    className: "word",
    textContent: text,
    title: line.firstChild.data.replace(/\s+/g, " "),
    tabIndex: 0,
    role: "button",
  });
  return made;
}

/* Makes the words of the page tell their lines, in the element `place`. */
export function explain(place) {
  // the state of the page stays where it is
  for (const link of words.querySelectorAll("a")) link.target = "_blank";
  for (const element of document.querySelectorAll("label, figcaption, .hint")) {
    const text = [...element.childNodes].find(
      ({ nodeType, data }) => nodeType === Node.TEXT_NODE && lines.has(data.trim()),
    );
    text?.replaceWith(word(text.data));
  }
  const show = event => {
    if (place.contains(event.target)) return;
    const shown = event.target.closest?.(".word");
    if (event.type === "keydown" && !(shown && event.key === "Enter")) return;
    place.hidden = !shown;
    if (!shown) return;
    // in a label a click would go to its input
    event.preventDefault();
    const name = document.createElement("b");
    name.textContent = shown.textContent.trim();
    place.replaceChildren(name, " ", ...lines.get(name.textContent).cloneNode(true).childNodes);
  };
  document.addEventListener("click", show);
  document.addEventListener("keydown", show);
}
