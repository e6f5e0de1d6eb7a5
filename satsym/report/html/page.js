"use strict";
const form = document.getElementById("filter-form");
const entries = [...document.querySelectorAll("[data-verdict]")];
const findings = entries.filter((entry) => entry.matches(".finding"));
const output = form.querySelector("output");

function show() {
  const wanted = [...form.querySelectorAll("select")].filter((choice) => choice.value);
  for (const entry of entries)
    entry.hidden = wanted.some((choice) => entry.dataset[choice.name] !== choice.value);
  for (const group of document.querySelectorAll("section.weight, details.all"))
    group.hidden = !group.querySelector("[data-verdict]:not([hidden])");
  const chosen = form.elements.document?.value;
  for (const part of document.querySelectorAll("main > section:not(#derived-equations)"))
    part.hidden = Boolean(chosen) && part.id !== chosen;
  const number = findings.filter((finding) => !finding.hidden).length;
  output.textContent = (number === 1 ? output.dataset.one : output.dataset.many).replace("<number>", number);
}

function reveal() {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!target) return;
  if (target.hidden || target.closest("[hidden]")) { form.reset(); show(); }
  for (let part = target; part; part = part.parentElement) if (part.matches("details")) part.open = true;
  target.scrollIntoView();
}

function openAll(value) {
  for (const part of document.querySelectorAll(".finding")) part.open = value;
}

form.hidden = false;
form.addEventListener("change", show);
form.elements.open.addEventListener("click", () => openAll(true));
form.elements.close.addEventListener("click", () => openAll(false));
addEventListener("hashchange", reveal);
addEventListener("beforeprint", () => openAll(true));
show();
reveal();
