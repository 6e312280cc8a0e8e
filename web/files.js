/* Files that come and go, and lines to copy. */

const FILES = {
  "fields.npz": "Fields",
  "contact.png": "Picture",
  "heights.npz": "Heights",
  "scene.toml": "Scene",
  "report.json": "Report",
  "start.npz": "Gap at the start",
  "table.csv": "Table of the cycle",
};

/* Those that are not always there. */
const SOMETIMES = ["start.npz", "table.csv"];

/* Takes files that are chosen, or dropped anywhere on the page. */
export function files(onfile) {
  const input = document.getElementById("file"),
    over = document.getElementById("over");
  document.getElementById("choose").addEventListener("click", () => input.click());
  input.addEventListener("change", () => {
    if (input.files[0]) onfile(input.files[0]);
    // the same file may be chosen again
    input.value = "";
  });
  const isOfFiles = event => event.dataTransfer?.types.includes("Files");
  const shown = is => event => {
    if (!isOfFiles(event)) return;
    event.preventDefault();
    over.hidden = !is;
  };
  document.addEventListener("dragover", shown(true));
  document.addEventListener("dragleave", event => event.relatedTarget ?? shown(false)(event));
  document.addEventListener("drop", event => {
    shown(false)(event);
    const [file] = event.dataTransfer?.files ?? [];
    if (file) onfile(file);
  });
}

/* The buttons that save files, with the content by `get`, and copy lines. */
export function takeAway(get, onerror) {
  const buttons = Object.entries(FILES).map(([file, text]) => {
    const button = document.createElement("button");
    Object.assign(button, { type: "button", textContent: text, title: file, hidden: SOMETIMES.includes(file) });
    button.dataset.file = file;
    button.addEventListener("click", () => save(get, file).catch(onerror));
    return button;
  });
  document.getElementById("files").replaceChildren(...buttons);
  for (const button of document.querySelectorAll("[data-copy]")) {
    button.addEventListener("click", () => copy(document.getElementById(button.dataset.copy), button));
  }
}

async function save(get, file) {
  const { name, type, bytes } = await get(file);
  const url = URL.createObjectURL(new Blob([bytes], { type }));
  Object.assign(document.createElement("a"), { href: url, download: name }).click();
  setTimeout(URL.revokeObjectURL, 60_000, url);
}

/* Copies a text; where the browser refuses it is selected, to be copied by the keys. */
async function copy(text, button) {
  try {
    await navigator.clipboard.writeText(text.textContent);
    button.textContent = "Copied";
  } catch {
    getSelection().selectAllChildren(text);
    button.textContent = "Selected";
  }
  setTimeout(() => (button.textContent = "Copy"), 1500);
}
