// Energy ledger: a bar that is divided into accounts (destinations of the light, such as absorption). The width of each
// account is its fraction of the power.
import { h } from "../dom.js";
import { percent, words } from "../units.js";

const MIN_LABELLED = 5e-5; // minimum fraction of the power for an account to be labelled

export class Ledger {
  constructor(session) {
    this.session = session;
    this.bar = h("div", { class: "ledger-bar", "aria-hidden": "true" });
    this.list = h("dl", { class: "ledger-list" });
    this.node = h("div", { class: "ledger", role: "group", "aria-label": "Ledger of the light" }, this.bar, this.list);
  }

  /** \param accounts list of {name, meaning} or of names, in the order of ledgers */
  start(accounts) {
    this.accounts = accounts.map((given) => {
      const account = typeof given === "string" ? { name: given, meaning: null } : given;
      const piece = h("i", { class: `account ${account.name}`, title: account.meaning });
      const value = h("dd", {});
      const line = h("div", { title: account.meaning, class: account.name }, h("dt", {}, h("span", { class: `swatch account ${account.name}` }), words(account.name)), value);
      this.bar.append(piece);
      this.list.append(line);
      return { ...account, piece, value, line };
    });
    this.session.on("answer", () => this.session.answer && this.show(this.session.answer.ledger));
    this.session.on("rested", (answer) => this.show(answer.ledger));
  }

  show(ledger) {
    this.accounts.forEach(({ piece, value, line, name }, k) => {
      const share = ledger[k] || 0;
      piece.style.width = `${100 * share}%`;
      value.textContent = percent(share, 2);
      line.hidden = share < MIN_LABELLED && name !== "retroreflected";
    });
    this.bar.dataset.sum = ledger.reduce((sum, share) => sum + share, 0);
  }
}
