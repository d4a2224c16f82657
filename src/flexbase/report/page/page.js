"use strict";
// Panels of a flexbase page: codes become words, plotly draws, and maps zoom together.
const content = JSON.parse(document.getElementById("data").textContent);
const GAP = 16;

function decode(array) {  // int8 rows
  const bytes = Uint8Array.from(atob(array.bdata), sign => sign.charCodeAt(0));
  const [rows, columns] = array.shape.split(",").map(Number);
  return Array.from({length: rows}, (_, i) => Array.from(bytes.subarray(i * columns, (i + 1) * columns)));
}

function spell(gaps, values) {
  const codes = decode(gaps.codes);
  gaps.text = values.text = codes.map(row => row.map(code => content.words[code % GAP] ?? ""));
  gaps.z = codes.map(row => row.map(code => code >= GAP ? 0 : null));
  delete gaps.codes;
}

const options = {
  responsive: true, displaylogo: false,
  showSendToCloud: false, showEditInChartStudio: false, plotlyServerURL: "",  // nothing leaves this file
  modeBarButtonsToRemove: ["sendChartToCloud", "sendDataToCloud", "lasso2d", "select2d", "autoScale2d"],
};
const places = content.panels.map((panel, i) => {
  const place = document.getElementById("panel-" + i);
  panel.data.forEach((trace, k) => { if (trace.codes) spell(trace, panel.data[k - 1]); });
  Plotly.newPlot(place, panel.data, panel.layout, options);
  return place;
});

let following = false;
function follow(source, change) {
  if (following) return;
  const update = {};
  for (const axis of ["xaxis", "yaxis"]) {
    if (axis + ".range[0]" in change) update[axis + ".range"] = source.layout[axis].range.slice();
    if (change[axis + ".autorange"]) update[axis + ".autorange"] = true;
    if (change[axis + ".range"]) update[axis + ".range"] = change[axis + ".range"].slice();
  }
  if (!Object.keys(update).length) return;
  following = true;
  Promise.all(places.filter(place => place !== source).map(place => Plotly.relayout(place, update)))
    .finally(() => { following = false; });
}
if (content.linked && places.length > 1) {
  places.forEach(place => place.on("plotly_relayout", change => follow(place, change)));
}
