// The machine is drawn in a frame of its own. It is told the test and the sensor that are chosen here, the theme, and
// keys pressed outside of it, and what is known of the machine later; it says which sensor was clicked, and what keys it
// has no use for.
(() => {
  const KEYS = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "+", "-", "0", " ", ",", "."];
  const ELSEWHERE = "input, select, textarea, button, a, summary, [role=slider], [role=listbox], [role=combobox]";
  const frame = () => document.getElementById("viewer");
  const say = (words) => frame()?.contentWindow.postMessage(words, location.origin);
  const tell = () => {
    const { test, sensor, dark, rest, limits } = frame()?.dataset ?? {};
    if (test) say({ test, sensor, dark: dark === "true", limits: JSON.parse(limits) });
    if (rest && rest !== given) complete(given = rest);
  };
  let given = "";
  const complete = async (address) => {
    const rest = await (await fetch(address)).json();
    if (frame()?.dataset.rest === address) say({ rest });
  };
  new MutationObserver(tell).observe(document, {
    subtree: true, attributes: true, attributeFilter: ["data-test", "data-sensor", "data-dark", "data-rest", "data-limits"],
  });
  addEventListener("message", (event) => {
    if (event.source !== frame()?.contentWindow || event.origin !== location.origin) return;
    if (event.data.ready) { given = ""; tell(); }
    if (event.data.key) {
      const code = event.data.key.charCodeAt(0);
      document.dispatchEvent(new KeyboardEvent("keypress", { key: event.data.key, charCode: code, keyCode: code, which: code }));
    }
    if (event.data.sensor) frame().dispatchEvent(new CustomEvent("pick", { detail: event.data.sensor }));
  });
  document.addEventListener("keydown", (event) => {
    if (!KEYS.includes(event.key) || event.target.closest?.(ELSEWHERE) || !frame()) return;
    event.preventDefault(); // else the page scrolls
    say({ key: event.key });
  });
})();
