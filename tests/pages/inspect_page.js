// What is wrong with the page as the browser shows it, as a list of sentences, for
// the callback that is the last argument. The others are the width of the screen,
// whether the page is written by hand, since Doxygen's lists have no headings, and for
// how many seconds MathJax may be late.
const width = arguments[0];
const isWritten = arguments[1];
const patience = arguments[2];
const done = arguments[arguments.length - 1];

// Text that should have been made something else of: formulas, commands of
// Doxygen, and markup.
const leftovers = ["\\(", "\\)", "\\[", "\\]", "\\begin", "\\ref", "\\frac", "@f",
                   "@ref", "@sect", "@code", "@page", "$", "`", "](", "**", "##",
                   "~~~"];
const verbatim = "code, pre, script, style, noscript, textarea, svg, .fragment, " +
  ".line, .memproto, .memtitle, .memItemLeft, .memItemRight, .memTemplParams, " +
  ".memTemplItemLeft, .memTemplItemRight, .MathJax, .MathJax_SVG, " +
  ".MathJax_Display, .MathJax_SVG_Display, .MathJax_Preview, .MJX_Assistive_MathML";

function short(text) {
  text = text.replace(/\s+/g, " ").trim();
  return text.length > 70 ? text.slice(0, 70) + " ..." : text;
}

function checkText(offences) {
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const node = walker.currentNode;
    if (!node.parentElement || node.parentElement.closest(verbatim))
      continue;
    const text = node.data.replace(/operator\[\]\(/g, "");
    const left = leftovers.find(one => text.includes(one));
    if (left)
      offences.push(`raw markup '${left}' in the text '${short(node.data)}'`);
  }
}

function checkPictures(offences) {
  for (const picture of document.images) {
    const name = picture.getAttribute("src");
    if (!name || name.startsWith("data:"))
      continue;
    const box = picture.getBoundingClientRect();
    if (!picture.complete || picture.naturalWidth === 0)
      offences.push(`the picture '${name}' has not been loaded`);
    else if (/\.(png|jpg|gif)$/.test(name) && box.width > picture.naturalWidth + 1)
      offences.push(`the picture '${name}' has ${picture.naturalWidth} pixels ` +
        `across and is stretched to ${Math.round(box.width)}`);
  }
}

function checkWidth(offences) {
  const found = document.documentElement.scrollWidth;
  if (found <= width + 1)
    return;
  // What is wider than the screen and is not in something that scrolls by itself.
  const wide = [...document.body.querySelectorAll("*")].filter(element => {
    const box = element.getBoundingClientRect();
    if (box.width === 0 || box.right + window.scrollX <= width + 1)
      return false;
    for (let e = element.parentElement; e && e !== document.body; e = e.parentElement)
      if (getComputedStyle(e).overflowX !== "visible")
        return false;
    return true;
  });
  const last = wide[wide.length - 1];
  offences.push(`the page is ${found} pixels wide, because of ` + (last ?
    `<${last.tagName.toLowerCase()} class="${last.getAttribute("class") || ""}"> ` +
    `'${short(last.textContent)}'` : "something that cannot be seen"));
}

// One heading stands above all others. Sections are h1 for Doxygen, too, so that
// what counts is the size in which they are shown.
function checkHeadings(offences) {
  if (!document.title.trim())
    offences.push("the page has no title");
  const size = element => parseFloat(getComputedStyle(element).fontSize);
  const headings = [...document.querySelectorAll("h1, .headertitle .title")]
    .filter(one => one.offsetParent !== null && !one.querySelector("h1"));
  const largest = Math.max(...headings.map(size));
  const first = headings.filter(one => size(one) === largest);
  if (isWritten && first.length !== 1)
    offences.push(`the page has ${first.length} headings of the largest size` +
      first.map(one => `, '${short(one.textContent)}'`).join(""));
}

function hasError(node) {
  return !!node && (node.type === "merror" ||
                    (node.type === "mtext" && node.mathcolor === "red") ||
                    (node.data || []).some(one => typeof one === "object" &&
                                                  hasError(one)));
}

function checkFormulas(offences) {
  const scripts = document.querySelectorAll('script[type^="math/tex"]');
  const formulas = window.MathJax && MathJax.Hub ? MathJax.Hub.getAllJax() : [];
  if (scripts.length !== formulas.length)
    offences.push(`${formulas.length} of ${scripts.length} formulas have been set`);
  for (const formula of formulas) {
    const place = document.getElementById(formula.inputID + "-Frame");
    const error = place && (place.matches(".MathJax_Error") ||
      place.querySelector(".MathJax_Error, merror, .merror, .mjx-merror"));
    if (!place || error || formula.texError || hasError(formula.root))
      offences.push(`the formula '${short(formula.originalText)}' has not been set`);
    else if (place.getBoundingClientRect().width === 0 && place.offsetParent !== null)
      offences.push(`nothing can be seen of the formula ` +
                    `'${short(formula.originalText)}'`);
  }
  for (const error of document.querySelectorAll(".MathJax_Error, merror"))
    offences.push(`a formula is an error: '${short(error.textContent)}'`);
}

function inspect() {
  const offences = [];
  for (const check of [checkFormulas, checkText, checkPictures, checkWidth,
                       checkHeadings])
    check(offences);
  done(offences);
}

// A change of the screen reaches the layout with a frame.
function inspectNextFrame() {
  requestAnimationFrame(() => requestAnimationFrame(inspect));
}

function hasRawText() {
  const offences = [];
  checkText(offences);
  return offences.length > 0;
}

// MathJax comes after the page, and is through when its queue is empty, or, on a
// machine that is busy, has not yet put its work there; it gets some more seconds as
// long as there is anything left to set.
const waiting = document.querySelector('script[src*="MathJax.js"]');
(function wait(turns) {
  if (!waiting)
    inspectNextFrame();
  else if (window.MathJax && MathJax.isReady)
    MathJax.Hub.Queue(() =>
      turns > 300 - 10 * patience && hasRawText()
        ? setTimeout(wait, 100, turns - 1)
        : inspectNextFrame());
  else if (turns === 0)
    done(["MathJax has not been loaded"]);
  else
    setTimeout(wait, 100, turns - 1);
})(300);
