// Formulas. Pages write them as repository viewers understand them: blocks marked `math`, and code between dollar signs within a line ($`x`$). MathJax gets them as its own scripts.
(function () {
    function formula(code, type) {
        var script = document.createElement("script");
        script.type = type;
        script.textContent = code.textContent;
        return script;
    }
    document.querySelectorAll("code.language-math").forEach(function (code) {
        code.parentNode.replaceWith(formula(code, "math/tex; mode=display"));
    });
    document.querySelectorAll("code").forEach(function (code) {
        var before = code.previousSibling, after = code.nextSibling;
        var text = function (node) { return node && node.nodeType === Node.TEXT_NODE ? node.data : ""; };
        if (text(before).endsWith("$") && text(after).startsWith("$")) {
            before.data = before.data.slice(0, -1);
            after.data = after.data.slice(1);
            code.replaceWith(formula(code, "math/tex"));
        }
    });
    if (window.MathJax && window.MathJax.Hub) {
        window.MathJax.Hub.Queue(["Typeset", window.MathJax.Hub]);
    }
})();
