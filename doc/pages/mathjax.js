// Inserted by Doxygen where it configures MathJax: no messages while formulas are
// set, no menu, and nothing that is not beside the pages.
MathJax.Hub.Config({
  messageStyle: "none",
  showMathMenu: false,
  showProcessingMessages: false,
  menuSettings: {zoom: "None", assistiveMML: false, collapsible: false,
                 explorer: false}
});

// Formulas in the text that are wider than the text scroll by themselves.
MathJax.Hub.Register.StartupHook("End", function() {
  document.querySelectorAll(".contents span.MathJax_SVG").forEach(
    function(formula) {
      var room = formula.closest("p, li, td, dd, div");
      if (room && formula.getBoundingClientRect().width > room.clientWidth)
        formula.classList.add("wide-formula");
    });
});
