// SPDX-License-Identifier: GPL-2.0-or-later
// The slider through the frames. Without this script they all stand side by side.
"use strict";
(function () {
  const row = document.getElementById("frames");
  const controls = document.getElementById("controls");
  if (!row || !controls || row.children.length === 0) return;
  const frames = Array.from(row.children);
  const slider = document.getElementById("slider");
  const play = document.getElementById("play");
  let timer = 0;

  function show(number) {
    const at = Math.min(Math.max(number, 1), frames.length);
    for (const frame of row.querySelectorAll(".now")) frame.classList.remove("now");
    frames[at - 1].classList.add("now");
    slider.value = at;
    slider.setAttribute("aria-valuetext", frames[at - 1].querySelector("figcaption").textContent);
  }

  function stop() {
    clearInterval(timer);
    timer = 0;
    play.textContent = "Play";
    play.setAttribute("aria-pressed", "false");
  }

  function start() {
    if (Number(slider.value) === frames.length) show(1);
    timer = setInterval(function () {
      if (Number(slider.value) === frames.length) stop();
      else show(Number(slider.value) + 1);
    }, 250);
    play.textContent = "Pause";
    play.setAttribute("aria-pressed", "true");
  }

  // A link to a frame, from the table of events or from outside.
  function follow() {
    const found = /^#frame-(\d+)$/.exec(location.hash);
    if (!found) return;
    stop();
    show(Number(found[1]));
    controls.scrollIntoView();
    slider.focus({ preventScroll: true });
  }

  slider.max = frames.length;
  slider.addEventListener("input", function () { stop(); show(Number(slider.value)); });
  document.getElementById("back").addEventListener("click", function () { stop(); show(Number(slider.value) - 1); });
  document.getElementById("on").addEventListener("click", function () { stop(); show(Number(slider.value) + 1); });
  play.addEventListener("click", function () { if (timer) stop(); else start(); });
  window.addEventListener("hashchange", follow);
  // The same link again changes no hash.
  document.addEventListener("click", function (event) {
    const link = event.target.closest("a[href^='#frame-']");
    if (link && link.getAttribute("href") === location.hash) follow();
  });

  row.classList.add("live");
  controls.hidden = false;
  document.getElementById("keys").hidden = false;
  show(Number(row.dataset.first) || 1);
  follow();
})();
