/* What was on the page before, by its links, and the way back to it. */

export class Undo {
  /* The `page` has a `link()` to what is on it, and can `take(link)`. */
  constructor(button, page) {
    Object.assign(this, { button, page, all: [], at: -1 });
    button.addEventListener("click", () => this.step(-1));
    document.addEventListener("keydown", event => {
      const isText = event.target.matches("input.quantity, input[type=number], textarea");
      if (event.key.toLowerCase() !== "z" || !(event.ctrlKey || event.metaKey) || isText) return;
      event.preventDefault();
      this.step(event.shiftKey ? 1 : -1);
    });
  }

  /* Keeps what is on the page, if that is something else. */
  keep() {
    const link = this.page.link();
    if (link !== this.all[this.at]) this.all.splice(++this.at, Infinity, link);
    this.button.disabled = this.at < 1;
  }

  /* Goes back, or forth again. */
  step(by) {
    this.keep();
    const link = this.all[this.at + by];
    if (link === undefined) return;
    this.at += by;
    this.page.take(link);
  }
}
