"use strict";
// The page that draws a fabric: one Vue component, mounted by trame, which carries its questions (desk.py).
//
// A number that moves is asked for again only when the last answer has come, and then with its newest value, so
// that the drawing follows the hand and never lags behind a queue. Figures and cuts are asked for after drawing.
const fabric_cad_design = (() => {
  const LABELS = {
    density_per_mm: ["density", "yarns per mm"], width_mm: ["width", "mm"], crimp: ["crimp", "ratio"],
    thickness_mm: ["thickness", "mm"], contact_top_mm: ["contact top", "mm"],
    contact_bottom_mm: ["contact bottom", "mm"], offset_top_mm: ["offset top", "mm"],
    offset_bottom_mm: ["offset bottom", "mm"], linear_density_tex: ["linear density", "tex"],
    fabric_thickness_mm: ["fabric thickness", "mm"], lateral_height_mm: ["side height", "mm"],
    fibre_density_g_cm3: ["fibre density", "g/cm\u00b3"],
  };
  const PER_DIRECTION = Object.keys(LABELS).slice(0, 9), SINGLE = Object.keys(LABELS).slice(9);
  const FILES = {step: "STEP", mesh: "mesh", deck: "deck", vtu: "VTU", report: "report", datasheet: "datasheet (PDF)"};
  const MARKS = {identifies: "\u25cf", compared: "\u2248", given: "", follows: "\u2190", empty: ""};
  const ROLES = {
    identifies: "identifies the fabric", compared: "measured beyond need, compared with the model", given: "",
    follows: "empty: follows from the others", empty: "",
  };
  const bytesOf = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0));

  // trame takes the token out of the address; it is put back, so that the page can be loaded again
  const QUERY = new URL(performance.getEntriesByType("navigation")[0].name).search;

  const Numbers = {
    props: ["column", "label", "quantity"],
    emits: ["change"],
    template: `
      <span class="quantity" :class="quantity.role" v-if="quantity">
        <span class="mark" :title="roles[quantity.role]" aria-hidden="true">{{ marks[quantity.role] }}</span>
        <input type="text" inputmode="decimal" :value="quantity.text" :id="'f-' + column"
          :placeholder="quantity.model === null ? '' : quantity.model.toPrecision(4)"
          :aria-label="label + ', ' + quantity.bound + (roles[quantity.role] ? ', ' + roles[quantity.role] : '')"
          :aria-invalid="!!quantity.refusal" :aria-describedby="quantity.refusal ? 'r-' + column : null"
          :title="quantity.bound" @change="$emit('change', column, $event.target.value, false)">
        <input type="range" :id="'s-' + column" :min="quantity.span[0]" :max="quantity.span[1]" :step="step"
          :value="quantity.text || quantity.model || 0" :aria-label="label + ', slider'"
          :disabled="!quantity.text" @input="$emit('change', column, short($event.target.value), true)">
        <span class="refusal" role="alert" :id="'r-' + column" v-if="quantity.refusal">{{ quantity.refusal }}</span>
      </span>`,
    computed: {
      marks: () => MARKS, roles: () => ROLES,
      step() { return (this.quantity.span[1] - this.quantity.span[0]) / 400 || 0.01; },
    },
    methods: {short: text => String(Number(Number(text).toPrecision(5)))},
  };

  const Design = {
    components: {Numbers},
    inject: ["trame"],
    data: () => ({
      row: null, told: {figures: [], comparisons: [], warnings: []}, cut: {svg: "", caption: ""}, notice: "",
      problem: "", exists: false, name: "", cells: 1, hidden: [], contact: false, direction: "weft", share: 0.5,
      cutting: false, job: {state: "none", stages: []}, at: [0, 0], painting: null, renderer: "", noView: false,
      over: "2", under: "2", harness: "5", step: "2", dropping: false,
    }),
    template: `
      <main class="design" v-if="row" @dragover.prevent="dropping = true" @dragleave="dropping = false"
          @drop.prevent="drop($event)" :class="{dropping}" @keydown="keys">
        <section class="weave" aria-label="weave">
          <h1>{{ row.name || "fabric" }}</h1>
          <p class="kind">{{ row.kind }}</p>
          <div class="grid" role="grid" aria-label="crossings, weft 1 at the bottom"
              :style="{gridTemplateColumns: 'repeat(' + warps + ', 1fr)'}" @keydown="walk" @pointerup="painted"
              @pointerleave="painted">
            <template v-for="i in wefts" :key="i">
              <button v-for="j in warps" :key="j" type="button" role="gridcell" :id="'x-' + (wefts - i) + '-' + (j - 1)"
                :class="over_(wefts - i, j - 1) ? 'weft' : 'warp'" @pointerdown="paint($event, wefts - i, j - 1)"
                @pointerenter="paint($event, wefts - i, j - 1)"
                :tabindex="at[0] === wefts - i && at[1] === j - 1 ? 0 : -1" @focus="at = [wefts - i, j - 1]"
                :aria-label="'weft ' + (wefts - i + 1) + (over_(wefts - i, j - 1) ? ' over' : ' under') + ' warp ' + j">
              </button>
            </template>
          </div>
          <p class="refusal" role="alert" v-for="p in weaveProblems" :key="p.message">{{ p.message }}</p>
          <div class="line">
            <label>wefts <input type="number" min="2" max="32" :value="wefts" id="wefts"
              @change="ask('resize', Number($event.target.value), warps)"></label>
            <label>warps <input type="number" min="2" max="32" :value="warps" id="warps"
              @change="ask('resize', wefts, Number($event.target.value))"></label>
          </div>
          <div class="line"><button type="button" @click="ask('weave', 'plain', {})">plain</button>
            <button type="button" @click="ask('weave', 'twill', {over, under})">twill</button>
            <input class="short" v-model="over" aria-label="twill: over"><input class="short" v-model="under"
              aria-label="twill: under">
          </div>
          <div class="line">
            <button type="button" @click="ask('weave', 'satin', {harness, step})">satin</button>
            <input class="short" v-model="harness" aria-label="satin: harness"><input class="short" v-model="step"
              aria-label="satin: step">
            <label class="file">.wif <input type="file" accept=".wif" id="wif" @change="upload($event.target.files[0])"></label>
          </div>
          <div class="line" role="group" aria-label="steps">
            <button type="button" id="undo" :disabled="!row.undo" @click="ask('undo')">undo</button>
            <button type="button" id="redo" :disabled="!row.redo" @click="ask('redo')">redo</button>
            <a :href="'#' + row.link" id="link" @click.prevent="copy">link</a>
          </div>
          <h2>Figures</h2>
          <table class="figures"><tbody>
            <tr v-for="f in told.figures" :key="f.label"><th scope="row">{{ f.label }}</th><td>{{ f.text }}</td></tr>
          </tbody></table>
          <p class="note" v-for="text in told.comparisons.concat(told.warnings)" :key="text">{{ text }}</p>
        </section>

        <section class="numbers" aria-label="numbers">
          <table>
            <thead><tr><th></th><th scope="col" class="weft">weft</th><th scope="col" class="warp">warp</th></tr></thead>
            <tbody>
              <tr v-for="q in perDirection" :key="q"><th scope="row">{{ labels[q][0] }}<small>{{ labels[q][1] }}</small></th>
                <td v-for="d in ['weft', 'warp']" :key="d"><Numbers :column="d + '_' + q" @change="change"
                  :label="d + ' ' + labels[q].join(', ')" :quantity="quantity[d + '_' + q]"/></td></tr>
              <tr v-for="q in single" :key="q"><th scope="row">{{ labels[q][0] }}<small>{{ labels[q][1] }}</small></th>
                <td><Numbers :column="q" :label="labels[q].join(', ')" :quantity="quantity[q]" @change="change"/></td>
                <td><label v-if="choices[q]">{{ choices[q] }}
                  <select :id="'f-' + choices[q]" :value="row.texts[choices[q]]"
                    @change="change(choices[q], $event.target.value, false)"><option value="">{{ choices[q] === 'thicker' ? 'not said' : row.choices[choices[q]][0] }}</option>
                    <option v-for="c in row.choices[choices[q]].slice(choices[q] === 'thicker' ? 0 : 1)" :key="c">{{ c }}</option></select></label></td></tr>
            </tbody>
          </table>
          <p class="refusal" role="alert" v-for="p in otherProblems" :key="p.message">{{ p.column }}: {{ p.message }}</p>
          <p class="note">\u25cf identifies the fabric, \u2190 follows, \u2248 measured beyond need and compared.
            All warp numbers empty: balanced.</p>
          <div class="out" role="group" aria-label="save and download">
            <div class="line"><label>name <input id="name" v-model="name"></label>
              <button type="button" id="save" @click="save(false)">save row</button>
              <button type="button" id="replace" v-if="exists" @click="save(true)">replace the row that is there</button></div>
            <div class="line"><button type="button" id="make" :disabled="job.state === 'running' || row.refused" @click="make">
                make STEP, mesh, deck</button>
              <button type="button" id="cancel" v-if="job.state === 'running'" @click="cancel">cancel</button>
              <button type="button" id="picture" @click="picture">picture</button>
              <button type="button" id="page" @click="page">page (HTML)</button></div>
            <p class="note" aria-live="polite" id="job">{{ jobText }}</p>
            <div class="line" v-if="job.state === 'done'">
              <button type="button" v-for="(label, kind) in files" :key="kind" :id="'get-' + kind" @click="get(kind)">
                {{ label }}</button></div>
            <p class="refusal" role="alert" id="problem" v-if="problem">{{ problem }}</p>
            <p class="note" role="status" id="notice">{{ notice }}</p>
          </div>
        </section>

        <section class="drawing" aria-label="view" :class="{refused: row.refused}">
          <canvas class="view" id="view" ref="canvas" tabindex="0" role="img" :aria-label="label"></canvas>
          <p class="note" v-if="noView">This browser has no WebGL2, by which the cell is drawn.</p>
          <div class="line">
            <label>cells <select id="cells" v-model.number="cells"><option v-for="n in 4" :key="n">{{ n }}</option></select></label>
            <label><input type="checkbox" id="contact" v-model="contact"> contact</label>
            <label><input type="checkbox" id="cutting" v-model="cutting"> cut the view</label>
            <details><summary>yarns</summary><div class="yarns">
              <label v-for="yarn in yarns" :key="yarn"><input type="checkbox" :value="yarn" :checked="!hidden.includes(yarn)"
                @change="toggle(yarn)"> {{ yarn.replace("_", " ") }}</label></div></details>
          </div>
          <div class="line"><label>cut along <select id="direction" v-model="direction"><option>weft</option>
              <option>warp</option></select></label>
            <label class="wide">at <input type="range" min="0" max="1" step="0.005" id="share" v-model.number="share"></label>
          </div>
          <div id="cut" v-html="cut.svg"></div><p class="caption">{{ cut.caption }}</p>
        </section>
      </main>`,
    computed: {
      labels: () => LABELS, perDirection: () => PER_DIRECTION, single: () => SINGLE, files: () => FILES,
      choices: () => ({fabric_thickness_mm: "thicker", lateral_height_mm: "section", fibre_density_g_cm3: "float_gap"}),
      quantity() { return Object.fromEntries(this.row.quantities.map(q => [q.column, q])); },
      wefts() { return this.row.grid.length; },
      warps() { return this.row.grid[0]?.length || 0; },
      yarns() {
        const names = (direction, n) => Array.from({length: n}, (_, k) => `${direction}_${k + 1}`);
        return [...names("weft", this.wefts), ...names("warp", this.warps)];
      },
      weaveProblems() { return this.row.problems.filter(p => ["pattern", "over", "under", "harness", "step"].includes(p.column)); },
      otherProblems() { return this.row.problems.filter(p => !this.weaveProblems.includes(p) && !this.quantity[p.column]); },
      label() { return `the cell, ${this.row.kind}` + this.told.figures.slice(0, 3).map(f => `, ${f.label} ${f.text}`).join(""); },
      jobText() {
        const stages = this.job.stages.map(([name, s]) => s === null ? `${name} ...` : `${name} ${s.toFixed(1)} s`).join(", ");
        return {none: "", running: stages || "starting ...", done: `made: ${stages}`, cancelled: "cancelled",
          failed: `failed: ${this.job.problem}`}[this.job.state];
      },
      shown() { return [this.cells, this.contact, this.cutting, this.direction, this.share, this.hidden.join()]; },
    },
    watch: {
      shown() { this.apply(); },
      direction() { this.after(); },
      share() { this.after(); },
    },
    async mounted() {
      this.tab = crypto.randomUUID();
      this.waiting = null;
      this.busy = false;
      await this.take(await this.call("open", decodeURI(location.hash.slice(1))));
      window.fabric_design = this;
    },
    methods: {
      async call(question, ...rest) {
        this.open = (this.open || 0) + 1;
        try {
          return await this.trame.trigger("ask", [this.tab, question, ...rest]);
        } finally {
          this.open -= 1;
        }
      },

      async ask(question, ...rest) {  // the newest question waits while one is answered
        if (this.busy) { this.waiting = [question, ...rest]; return; }
        this.busy = true;
        try {
          await this.take(await this.call(question, ...rest));
        } finally {
          this.busy = false;
        }
        const next = this.waiting;
        this.waiting = null;
        if (next) this.ask(...next);
      },

      async take(answer) {
        this.answered = performance.now();
        this.problem = answer.problem || "";
        this.exists = !!answer.exists;
        this.notice = answer.done || "";
        if (answer.scene) {
          this.scene = Object.freeze(answer.scene);
          if (this.view) this.view.show(this.scene);
        }
        if (answer.row) {
          if (!this.row || this.row.name !== answer.row.name) this.name = answer.row.name;
          this.row = answer.row;
          history.replaceState(null, "", location.pathname + QUERY + "#" + answer.row.link);
          if (!this.view) { this.share = 0.5 / this.wefts; await this.begin(); }
          if (answer.scene) this.after();
        }
      },

      async begin() {
        await this.$nextTick();
        const view = fabricView(this.$refs.canvas);
        this.noView = !view;
        this.view = view && Vue.markRaw(view);
        if (view) { this.renderer = view.renderer; view.show(this.scene); window.fabric = view; }
      },

      after() {  // figures and cut, once the hand rests
        clearTimeout(this.later);
        this.later = setTimeout(async () => {
          const cut = await this.call("cut", this.direction, this.share);
          if (cut.svg) this.cut = cut;
          const told = await this.call("figures");
          if (told.figures) this.told = told;
        }, 120);
      },

      apply() {
        if (!this.view) return;
        const axis = this.direction === "weft" ? "y" : "x";
        const period = this.scene.period[axis === "y" ? 1 : 0];
        this.view.set({cells: [this.cells, this.cells], hidden: this.hidden, contact: this.contact,
          cut: this.cutting ? {axis, place: this.share * period + (this.cells - 1) * period} : null});
      },

      change(column, text, moving) { this.ask("change", column, text, moving); },
      over_(weft, warp) { return this.row.grid[weft][warp] === "1"; },
      toggle(yarn) {
        this.hidden = this.hidden.includes(yarn) ? this.hidden.filter(y => y !== yarn) : [...this.hidden, yarn];
      },

      paint(event, weft, warp) {  // press and drag over many; all of them are one step
        if (event.type === "pointerdown") {
          event.target.releasePointerCapture?.(event.pointerId);
          this.painting = new Map();
        }
        if (!this.painting || !event.buttons) return;
        this.painting.set(`${weft},${warp}`, [weft, warp]);
        event.target.classList.add("painting");
      },
      painted() {
        if (!this.painting?.size) { this.painting = null; return; }
        const crossings = [...this.painting.values()];
        this.painting = null;
        document.querySelectorAll(".painting").forEach(cell => cell.classList.remove("painting"));
        this.ask("flip", crossings);
      },
      walk(event) {
        const step = {ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1]}[event.key];
        if (step) {
          const to = [(this.at[0] + step[0] + this.wefts) % this.wefts, (this.at[1] + step[1] + this.warps) % this.warps];
          this.at = to;
          this.$nextTick(() => document.getElementById(`x-${to[0]}-${to[1]}`).focus());
        } else if (event.key === " " || event.key === "Enter") {
          this.ask("flip", [this.at]);
        } else return;
        event.preventDefault();
        event.stopPropagation();
      },
      keys(event) {
        if (!(event.ctrlKey || event.metaKey) || !["z", "y", "Z"].includes(event.key)) return;
        event.preventDefault();
        this.ask(event.key === "z" ? "undo" : "redo");
      },

      drop(event) { this.dropping = false; if (event.dataTransfer.files.length) this.upload(event.dataTransfer.files[0]); },
      async upload(file) {
        if (!file) return;
        if (file.size > 1e6) { this.problem = `${file.name} is larger than any draft`; return; }
        this.ask("draft", file.name, await file.text());
      },
      async copy() {
        await navigator.clipboard?.writeText(location.href).catch(() => null);
        this.notice = "the address holds the row; whoever opens it on this machine sees this fabric";
      },
      save(over) { this.ask("save", this.name, over); },

      async make() { await this.jobTold("run"); this.follow(); },
      async cancel() { await this.jobTold("cancel"); },
      async jobTold(what) {
        const answer = await this.trame.trigger(what, [this.tab]);
        this.problem = answer.problem && answer.state === undefined ? answer.problem : "";
        if (answer.state) this.job = answer;
      },
      follow() {
        if (this.job.state === "running") setTimeout(async () => { await this.jobTold("job"); this.follow(); }, 400);
      },
      async get(kind) {
        const file = await this.trame.trigger("file", [this.tab, kind]);
        if (file.problem) { this.problem = file.problem; return; }
        this.hand(file.name, new Blob([bytesOf(file.text)], {type: file.type}));
      },
      async page() {
        const page = await this.call("page");
        if (page.text) this.hand(page.name, new Blob([page.text], {type: "text/html"}));
      },
      async picture() {
        const image = bytesOf(this.view.picture().split(",")[1]);
        this.hand(`${this.row.name || "fabric"}.png`, new Blob([image], {type: "image/png"}));
      },
      hand(name, blob) {
        const link = Object.assign(document.createElement("a"), {href: URL.createObjectURL(blob), download: name});
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 10000);
      },
    },
  };

  return {install: app => app.component("fabric-design", Design)};
})();
