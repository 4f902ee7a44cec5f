// Curves are drawn by Plotly, 4.6 MB of script: the page and the machine do not wait for it.
(() => {
  const AFTER = 500, LATEST = 4000, LONGEST = 30000; // ms: after the machine's first picture, without one, with a slow one
  let begun = false;
  const begin = () => {
    if (begun) return;
    begun = true;
    const script = document.createElement("script");
    script.src = trame.state.get("plotly");
    script.onload = () => {
      document.querySelector("#app").__vue_app__.use(window.trame_plotly);
      trame.state.set("plots", Date.now()); // another key each time: what a reloaded page drew without it is drawn again
    };
    document.head.append(script);
  };
  const watched = new MutationObserver(() => {
    if (!document.getElementById("missing")) return;
    watched.disconnect();
    // The page begins with the paper of the browser's other pages
    if (matchMedia("(prefers-color-scheme: dark)").matches && !trame.state.get("dark")) trame.trigger("paper");
    setTimeout(begin, LONGEST);
    setTimeout(() => document.getElementById("viewer") || begin(), document.querySelector(".machine .flat") ? 0 : LATEST);
  });
  watched.observe(document, { subtree: true, childList: true });
  addEventListener("message", (event) => {
    if (event.origin === location.origin && event.data.ready) setTimeout(begin, AFTER);
  });
})();
