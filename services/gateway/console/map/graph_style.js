// How nodes and edges look; the colours are those of the style sheet, light or dark.

export function look() {
  const colours = getComputedStyle(document.documentElement);
  const colour = (name) => colours.getPropertyValue(`--${name}`).trim();
  return [
    { selector: "node", style: {
      width: 17, height: 17, "background-color": colour("place"), "border-width": 2, "border-color": colour("card"),
      label: "data(label)", color: colour("text"), "font-size": 10, "text-valign": "bottom", "text-margin-y": 3,
      "min-zoomed-font-size": 8, "text-outline-width": 2, "text-outline-color": colour("card"),
    } },
    { selector: "edge", style: { width: 2, "line-color": colour("edge"), "curve-style": "haystack" } },
    { selector: "edge.suspended", style: { "line-style": "dashed", opacity: 0.7 } },
    { selector: "edge.path", style: { width: 5, "line-color": colour("via") } },
    { selector: "edge.guess", style: { width: 2, "line-style": "dotted", "line-color": colour("target"), "curve-style": "straight" } },
    { selector: "node.many", style: { label: "", "border-width": 0 } },
    { selector: "node.unplaced", style: { display: "none" } },
    { selector: "node.seen", style: { "underlay-color": colour("target"), "underlay-opacity": 0.25, "underlay-padding": 9, "underlay-shape": "ellipse" } },
    { selector: "node.area", style: { "underlay-color": colour("place"), "underlay-opacity": 0.25, "underlay-padding": 9, "underlay-shape": "ellipse" } },
    { selector: "node.forbidden", style: { shape: "octagon", "background-color": colour("danger"), "underlay-color": colour("danger"),
      "underlay-opacity": 0.25, "underlay-padding": 11, "underlay-shape": "ellipse" } },
    { selector: "node.picked", style: { "border-width": 4, "border-color": colour("accent") } },
    { selector: "edge.ruled", style: { width: 4, "line-color": colour("warn") } },
    { selector: "edge.on-route", style: { width: 6, "line-color": colour("accent") } },
    { selector: "node.on-route", style: { "border-width": 3, "border-color": colour("accent") } },
    { selector: "node.route-start", style: { "border-color": colour("start"), width: 22, height: 22 } },
    { selector: "node.via", style: { "background-color": colour("via") } },
    { selector: "node.start", style: { "background-color": colour("start") } },
    { selector: "node.target", style: { "background-color": colour("target") } },
    { selector: "node.near", style: { "border-width": 4, "border-color": colour("warn") } },
    { selector: "node.robot", style: { shape: "round-rectangle", width: "label", height: 14, padding: 3, label: "data(label)", "text-valign": "center",
      "text-margin-y": 0, "text-outline-width": 0, "font-weight": "bold", color: colour("card"), "background-color": colour("text"), "z-index": 10 } },
    { selector: "node.followed", style: { "background-color": colour("warn") } },
    { selector: ".chosen", style: { "overlay-color": colour("accent"), "overlay-opacity": 0.3, "overlay-padding": 6 } },
  ];
}
