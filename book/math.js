// Formulas. Pages write them as repository viewers understand them: blocks marked `math`, and code between dollar signs within a line ($`x`$). KaTeX, which is part of the book (src/katex), renders them without network. Until it is loaded, or without it, the source of the formulas remains visible.
(function () {
    "use strict";
    var formulas = [];
    document.querySelectorAll("code.language-math").forEach(function (code) {
        formulas.push({ source: code.textContent, display: true, place: code.parentNode });
    });
    document.querySelectorAll("code").forEach(function (code) {
        var before = code.previousSibling, after = code.nextSibling;
        var text = function (node) { return node && node.nodeType === Node.TEXT_NODE ? node.data : ""; };
        if (text(before).endsWith("$") && text(after).startsWith("$")) {
            before.data = before.data.slice(0, -1);
            after.data = after.data.slice(1);
            formulas.push({ source: code.textContent, display: false, place: code });
        }
    });
    if (formulas.length === 0) {
        return;
    }
    // mdBook defines path_to_root on each page.
    var folder = (typeof path_to_root === "string" ? path_to_root : "") + "katex/";
    var style = document.createElement("link");
    style.rel = "stylesheet";
    style.href = folder + "katex.min.css";
    document.head.appendChild(style);
    var script = document.createElement("script");
    script.src = folder + "katex.min.js";
    script.onload = function () {
        formulas.forEach(function (formula) {
            var rendered = document.createElement(formula.display ? "div" : "span");
            katex.render(formula.source, rendered, { displayMode: formula.display, throwOnError: false });
            formula.place.replaceWith(rendered);
        });
    };
    document.head.appendChild(script);
})();
