/* Loads that are solved while nothing else is, on a thread of their own. */

/* The rest of the page before the first of them, in milliseconds. */
const WAIT = 700;

export class Fill {
  constructor(engine) {
    this.engine = engine;
  }

  stop() {
    clearTimeout(this.timer);
    this.twin?.cancel();
  }

  /* Solves scenes one after the other once the page rests, or the path of a state with this `gap`, which ends where one
     does not converge; `onfound(account)` hears of each. */
  start(scenes, onfound, gap) {
    this.stop();
    this.timer = setTimeout(() => this.run(scenes, onfound, gap), WAIT);
  }

  async run(scenes, onfound, gap) {
    const twin = (this.twin = this.engine.twin());
    try {
      if (gap) await twin.startFrom(gap);
      for (const scene of scenes) {
        const { account } = await twin.solve(scene, { start: "last", fields: [] });
        if (account.status === "converged") onfound(account);
        else if (gap) break;
      }
    } catch {
      // the page itself says what is wrong with a scene
    }
    twin.end();
  }
}
