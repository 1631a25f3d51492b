// Two panoramas, one above the other, with the matches between them.

const GAP_PX = 20;
const MOST_LINES = 150;

function load(src) {
  return new Promise((resolve, reject) => {
    const image = new Image();
    image.addEventListener("load", () => resolve(image));
    image.addEventListener("error", () => reject(new Error("a picture of this pair is missing")));
    image.src = src;
  });
}

/** `match.matches_rad` holds longitude and latitude in the first picture, then in the second. */
export async function drawPair(canvas, sources, match) {
  const pictures = await Promise.all(sources.map(load));
  const context = canvas.getContext("2d");
  const { width } = canvas;
  const height = width / 2;
  context.clearRect(0, 0, width, canvas.height);
  pictures.forEach((picture, index) => context.drawImage(picture, 0, index * (height + GAP_PX), width, height));
  const at = (lon, lat, top) => [width / 2 - (lon * width) / (2 * Math.PI), top + height / 2 - (lat * height) / Math.PI];
  const colours = getComputedStyle(document.documentElement);
  const order = match.matches_rad.map((_, index) => index).sort((one, two) => match.inlier[one] - match.inlier[two]);
  const kept = order.slice(-MOST_LINES);
  for (const index of kept) {
    const [lon, lat, otherLon, otherLat] = match.matches_rad[index];
    const [x, y] = at(lon, lat, 0);
    const [u, v] = at(otherLon, otherLat, height + GAP_PX);
    context.strokeStyle = colours.getPropertyValue(match.inlier[index] ? "--match" : "--mismatch").trim();
    context.globalAlpha = match.inlier[index] ? 0.75 : 0.35;
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(u, v);
    context.stroke();
    for (const [px, py] of [[x, y], [u, v]]) context.strokeRect(px - 2, py - 2, 4, 4);
  }
  context.globalAlpha = 1;
}
