// Recordings dropped anywhere on the page, or chosen in its list of files, go to the server. What it takes their
// columns for comes back through the page's state.
(() => {
  const send = async (files) => {
    const body = new FormData();
    for (const file of files) body.append("recording", file, file.name);
    await fetch("recordings", { method: "POST", body });
  };
  const carriesFiles = (event) => Array.from(event.dataTransfer?.types ?? []).includes("Files");
  document.addEventListener("dragover", (event) => {
    if (carriesFiles(event)) event.preventDefault();
  });
  document.addEventListener("drop", (event) => {
    if (!carriesFiles(event)) return;
    event.preventDefault(); // else the browser opens the file and leaves the page
    send(event.dataTransfer.files);
  });
  document.addEventListener("change", (event) => {
    if (event.target.id === "recordings") send(event.target.files);
  });
})();
