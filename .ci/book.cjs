// Opens all pages of the book in headless Chromium without network: book.cjs FOLDER
// Fails after an error in the console, a request to anything but a file of the book, a missing file, a missing picture, an
// empty page, or a formula that is not rendered.
const fs = require("fs");
const path = require("path");
const puppeteer = require("puppeteer-core");

const folder = path.resolve(process.argv[2]);
const chromium = process.env.CHROMIUM || ["/usr/bin/chromium", "/usr/bin/google-chrome"].find((one) => fs.existsSync(one));

/** Returns the number of rendered formulas of a page, and its problems. */
async function check(browser, file) {
  const page = await browser.newPage();
  const problems = [];
  page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
  page.on("pageerror", (error) => problems.push(String(error)));
  page.on("request", (request) => /^(file|data|blob):/.test(request.url()) || problems.push("request to " + request.url()));
  page.on("requestfailed", (request) => problems.push("cannot load " + request.url()));
  await page.goto("file://" + path.join(folder, file), { waitUntil: "networkidle0" });
  const found = await page.evaluate(() => ({
    title: document.querySelector("main h1")?.textContent,
    formulas: document.querySelectorAll(".katex").length,
    sources: [...document.querySelectorAll("code.language-math, .katex-error")].map((one) => one.textContent),
    missing: [...document.images].filter((image) => image.naturalWidth === 0).map((image) => image.src),
  }));
  await page.close();
  if (!found.title) problems.push("no title");
  problems.push(...found.sources.map((source) => "not rendered: " + source));
  problems.push(...found.missing.map((source) => "no picture " + source));
  return { formulas: found.formulas, problems: problems.map((problem) => `${file}: ${problem}`) };
}

(async () => {
  const browser = await puppeteer.launch({ executablePath: chromium, headless: true, args: ["--no-sandbox", "--host-resolver-rules=MAP * ~NOTFOUND"] });
  const problems = [];
  let formulas = 0;
  // print.html repeats all pages; the others are no pages of the book.
  const others = ["print.html", "404.html", "toc.html"];
  const files = fs.readdirSync(folder, { recursive: true }).filter((file) => file.endsWith(".html") && !others.includes(file));
  for (const file of files) {
    const page = await check(browser, file);
    formulas += page.formulas;
    problems.push(...page.problems);
  }
  await browser.close();
  if (formulas === 0) problems.push("the book has no formulas");
  console.log([...problems, `book: ${files.length} pages, ${formulas} formulas`].join("\n"));
  process.exit(problems.length ? 1 : 0);
})().catch((error) => {
  console.error(error.message || error);
  process.exit(1);
});
