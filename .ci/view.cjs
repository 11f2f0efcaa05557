// Operates the pages of runs in headless Chromium: view.cjs SCREENSHOTS FOLDER...
// Each folder has fields.html and, for comparison, fields-csv. Fails after an error in the console, a request to anything but
// the page, a blank picture, a control without effect, or values that differ from the tables.
const fs = require("fs");
const path = require("path");
const assert = require("assert");
const puppeteer = require("puppeteer-core");

const [place, ...folders] = process.argv.slice(2);
const chromium = process.env.CHROMIUM || ["/usr/bin/chromium", "/usr/bin/google-chrome"].find((one) => fs.existsSync(one));

/** Returns the columns of a table. */
function table(file) {
  const [head, ...rows] = fs.readFileSync(file, "utf8").trim().split("\n").map((line) => line.split(","));
  return Object.fromEntries(head.map((name, k) => [name.replace(/ \[.*/, ""), rows.map((row) => (row[k] === "" ? NaN : Number(row[k])))]));
}

async function check(browser, folder) {
  const name = path.basename(folder);
  const page = await browser.newPage();
  await page.setViewport({ width: 1280, height: 800 });
  const problems = [];
  page.on("console", (message) => ["error", "warn"].includes(message.type()) && problems.push(message.text()));
  page.on("pageerror", (error) => problems.push(String(error)));
  const own = "file://" + path.resolve(folder, "fields.html");
  page.on("request", (request) => {
    const url = request.url();
    if (url !== own && !/^(data|blob):/.test(url)) problems.push("request to " + url);
  });
  await page.goto(own);
  await page.waitForFunction("viewer.ready", { timeout: 60000 });
  const drawn = () => page.waitForFunction("!viewer.waiting", { polling: 20 });
  const picture = async () => {
    await drawn();
    return page.evaluate(() => {
      const canvas = document.querySelector("#profile canvas") || document.getElementById("scene");
      const pixels = document.createElement("canvas");
      [pixels.width, pixels.height] = [canvas.width, canvas.height];
      const pen = pixels.getContext("2d");
      pen.drawImage(canvas, 0, 0);
      const data = new Uint32Array(pen.getImageData(0, 0, canvas.width, canvas.height).data.buffer);
      const colours = new Set(data);
      let sum = 0;
      for (const value of data) sum = (Math.imul(sum, 31) + value) | 0;
      return { colours: colours.size, sum };
    });
  };
  const shot = (what) => page.screenshot({ path: path.join(place, `${name}-${what}.png`) });
  const set = (id, value, type) => page.evaluate((id, value, type) => {
    const control = document.getElementById(id);
    control.value = value;
    control.dispatchEvent(new Event(type, { bubbles: true }));
  }, id, value, type);
  const toFrame = async (frame) => {
    await set("time", frame, "input");
    await page.waitForFunction((frame) => viewer.frame === frame, { polling: 20 }, frame);
  };
  const changes = async (what, act) => {
    const before = await picture();
    await act();
    const after = await picture();
    assert.notStrictEqual(after.sum, before.sum, `${name}: ${what} does not change the picture`);
  };
  const info = await page.evaluate(() => ({ frames: header.times.length, dimension: header.dimension, fields: header.fields.map((one) => one.name), steps: header.steps.length }));

  // Time, with a displacement that is visible in every run.
  await page.evaluate(() => {
    viewer.chooseField(fieldNamed("Displacement"));
    return viewer.show(0);
  });
  const first = await picture();
  await changes("the time slider", () => toFrame(info.frames - 1));
  assert((await picture()).colours > 8, `${name}: the picture is blank (${first.colours} colours)`);
  await shot("displacement");
  await page.focus("#time");
  await page.keyboard.press("ArrowLeft");
  await page.waitForFunction(`viewer.frame === ${info.frames - 2}`);
  await toFrame(info.frames - 1);

  // Fields and their values.
  for (const field of info.fields) {
    await set("field", field, "change");
    await page.waitForFunction((field) => viewer.field.name === field && !viewer.waiting, {}, field);
  }
  const last = Math.max(...fs.readdirSync(path.join(folder, "fields-csv")).map((file) => Number(file.match(/\d+/)[0])));
  assert.strictEqual(last, info.frames - 1);
  const columns = table(path.join(folder, "fields-csv", `fields_${String(last).padStart(6, "0")}.csv`));
  const shown = await page.evaluate(async (frame) => {
    const all = [];
    for (const field of header.fields) {
      const values = await viewer.series.read(field, frame);
      values.forEach((one, c) => all.push({ name: field.components.length ? `${field.name}_${field.components[c]}` : field.name, step: field.frames[frame].step[c], values: Array.from(one, (v) => (isNaN(v) ? null : v)) }));
    }
    return all;
  }, last);
  for (const { name: column, step, values } of shown) {
    // Components of vectors that are no axes are numbered from 0 in tables.
    const exact = columns[column] || columns[column.replace(/_(\d)$/, (_, k) => "_" + "xyz"[k - 1])];
    assert(exact, `${name}: the table has no column ${column}`);
    exact.forEach((value, i) => {
      if (isNaN(value)) return assert.strictEqual(values[i], null);
      assert(Math.abs(values[i] - value) <= 0.51 * step + 1e-12 * Math.abs(value), `${name}: ${column} of point ${i} is ${values[i]} instead of ${value}`);
    });
  }
  await page.evaluate(() => {
    viewer.chooseField(fieldNamed("Velocity") || fieldNamed("Damage") || header.fields[0]);
    return viewer.show(viewer.frame);
  });
  await shot("field");
  await page.evaluate(() => {
    viewer.chooseField(preferredField());
    return viewer.show(viewer.frame);
  });

  // Deformation, colours, point, chart.
  if (info.dimension > 1) {
    await changes("the deformation scale", () => set("scale", "30", "change"));
    await page.click("#reset");
    await shot("deformed");
    await changes("the colour map", () => set("map", "grey", "change"));
    await set("map", "", "change");
    await set("scale", "1", "change");
    await page.click("#reset");
    const point = await page.evaluate(() => {
      const [x, y] = viewer.camera.project(...viewer.drawn.places.subarray(0, 3));
      const box = document.getElementById("overlay").getBoundingClientRect();
      return [box.x + x, box.y + y];
    });
    await page.mouse.click(...point);
    await page.waitForFunction("document.querySelectorAll('#point tr').length > 3", { timeout: 5000 });
  }
  if (info.dimension === 3) {
    if (await page.evaluate(() => header.triangles === null)) {
      await changes("clipping", () => set("clip", "1", "change"));
      await shot("clipped");
      await set("clip", "", "change");
    }
    await changes("rotation", async () => {
      await page.mouse.move(400, 300);
      await page.mouse.down();
      await page.mouse.move(480, 340, { steps: 4 });
      await page.mouse.up();
    });
  }
  const over = await page.$("#charts .u-over");
  assert(over, `${name}: there is no chart`);
  await over.evaluate((one) => one.scrollIntoView());
  const box = await over.boundingBox();
  await page.mouse.click(box.x + 2, box.y + 40);
  await page.waitForFunction("viewer.frame === 0", { timeout: 5000 });
  const playing = await page.evaluate(() => (viewer.play(), viewer.playing));
  assert(playing);
  await page.waitForFunction("viewer.frame >= 3", { timeout: 20000 });
  await page.evaluate(() => viewer.play());
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "dark" }]);
  await toFrame(info.frames - 1);
  await drawn();
  await shot("dark");
  assert.strictEqual(info.steps > 0, name === "steps");
  assert.deepStrictEqual(problems, [], name);
  await page.close();
  if (info.dimension === 2) await checkNotebook(browser, own);
  console.log(`${name}: ${info.frames} output times of ${info.fields.join(", ")}`);
}

/** Opens a page as notebooks do. */
async function checkNotebook(browser, address) {
  const notebook = await browser.newPage();
  const text = fs.readFileSync(address.slice("file://".length), "utf8").replaceAll("&", "&amp;").replaceAll('"', "&quot;");
  await notebook.setContent(`<iframe sandbox="allow-scripts allow-downloads" style="width: 900px; height: 600px" srcdoc="${text}"></iframe>`);
  const frame = await (await notebook.waitForSelector("iframe")).contentFrame();
  await frame.waitForFunction("viewer.ready", { timeout: 60000 });
  await notebook.close();
}

(async () => {
  const browser = await puppeteer.launch({
    executablePath: chromium, headless: true,
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--host-resolver-rules=MAP * ~NOTFOUND"],
  });
  try {
    for (const folder of folders) await check(browser, folder);
  } finally {
    await browser.close();
  }
})().catch((error) => {
  console.error(error.message || error);
  process.exit(1);
});
