"use strict";

// ---- Helpers of every page's script. Without a script, all pictures, figures and texts are there.
const byId = (id) => document.getElementById(id);
const all = (selector, within = document) => [...within.querySelectorAll(selector)];

// An element: attributes are set, functions are listeners, the rest are children.
const element = (space) => (tag, attributes = {}, ...children) => {
  const made = space ? document.createElementNS(space, tag) : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(name, value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return made;
};
const html = element(null);

// A time, as long ago as it is now.
const STEPS_AGO = [["day", 86400], ["hour", 3600], ["minute", 60], ["second", 1]];
const showTimes = () => {
  const format = new Intl.RelativeTimeFormat("en", { numeric: "auto" });
  for (const time of all("time[data-ago]")) {
    const seconds = Math.round((Date.parse(time.dateTime) - Date.now()) / 1000);
    const [unit, length] = STEPS_AGO.find(([, length]) => Math.abs(seconds) >= length) ?? STEPS_AGO.at(-1);
    time.title = new Date(time.dateTime).toLocaleString();
    time.textContent = format.format(Math.trunc(seconds / length), unit);
  }
};
if (document.querySelector("time[data-ago]")) {
  showTimes();
  setInterval(showTimes, 30000);
}
