"""What the thesis states about its methods' order, checked on our figures (THESIS rows 32-34, 37-39)."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from experiments.monte_carlo.ahae import Statistics
from experiments.monte_carlo.scene import Placement

Figures = dict[Placement, Statistics]
Values = Callable[[Figures], dict[str, float]]
Check = Callable[[Figures], tuple[bool, str]]
UNWEIGHTED, WEIGHTED = ("1", "3", "5"), ("2", "4", "6")


@dataclass(frozen=True)
class Claim:
    """One statement.

    Attributes:
        row: of the thesis's checklist.
        measure: 'ahae' or 'dcpe'.
        text: the statement.
        check: verdict and the figures it rests on.
    """

    row: int
    measure: str
    text: str
    check: Check


def judged(claims: Sequence[Claim], figures: dict[str, Figures]) -> list[dict[str, object]]:
    """Verdict on every claim whose measure is there."""
    verdicts: list[dict[str, object]] = []
    for claim in claims:
        if claim.measure in figures:
            holds, evidence = claim.check(figures[claim.measure])
            verdicts.append({"row": claim.row, "claim": claim.text, "holds": holds, "evidence": evidence})
    return verdicts


def _apart(values: Values, low: Sequence[str], high: Sequence[str], what: str) -> Check:
    """All methods of `low` have smaller figures than any of `high`."""

    def check(f: Figures) -> tuple[bool, str]:
        found = values(f)
        holds = max(found[m] for m in low) < min(found[m] for m in high)
        return holds, f"{what}, {_told(found)}"

    return check


def _worst(placement: Placement, measure: str, method: str = "3") -> Check:
    def check(f: Figures) -> tuple[bool, str]:
        values = getattr(f[placement], measure)()
        return max(values, key=values.__getitem__) == method, f"{measure.replace('_', ' ')}, {_told(values)}"

    return check


def _steadier(placement: Placement, measure: str, most: int) -> Check:
    def values(f: Figures) -> dict[str, float]:
        found: dict[str, float] = getattr(f[placement], measure)(
            [n for n in f[placement].counts if n <= most]
        )
        return found

    what = f"{measure.replace('_', ' ')} up to {most} matches"
    return _apart(values, ("4", "5", "6"), ("1", "2", "3"), what)


def _similar(f: Figures) -> tuple[bool, str]:
    values = {m: v for m, v in f["centre"].mean_of_means().items() if m != "3"}
    ratio = max(values.values()) / min(values.values())
    return ratio <= 1.5, f"largest over smallest mean without method 3: {ratio:.2f}; {_told(values)}"


def _steeper(f: Figures) -> tuple[bool, str]:
    north_east = f["north_east"]
    few, enough = north_east.mean_of_stds([min(north_east.counts)]), north_east.mean_of_stds([34])
    slopes = {m: few[m] - enough[m] for m in few}
    return max(slopes, key=slopes.__getitem__) == "4", f"growth of the deviation below 34, {_told(slopes)}"


def _spread_grows(f: Figures) -> tuple[bool, str]:
    north, corner = f["north"].std_of_means(), f["north_east"].std_of_means()
    grows = all(corner[m] > north[m] for m in ("4", "6"))
    return (
        grows,
        f"method 4: {north['4']:.1f} to {corner['4']:.1f}, method 6: {north['6']:.1f} to {corner['6']:.1f}",
    )


def _outside_box(f: Figures) -> tuple[bool, str]:
    outside = f["north_east"].mean_outside_box("2")
    return bool(outside), f"method 2: mean above the upper quartile at {list(outside) or 'no'} matches"


def _small(f: Figures) -> tuple[bool, str]:
    most = [max(f["centre"].counts)]
    both = {
        m: max(f["centre"].std_of_stds(most)[m], f["centre"].std_of_means(most)[m])
        for m in UNWEIGHTED + WEIGHTED
    }
    return max(both.values()) < 5.0, f"larger of the two spreads at {most[0]} matches, {_told(both)}"


def _combined_best(f: Figures) -> tuple[bool, str]:
    values = f["centre"].mean_of_stds([n for n in f["centre"].counts if n < 13])
    best = sorted(values, key=values.__getitem__)[:2]
    return set(best) == {"5", "6"}, f"mean deviation below 13 matches, {_told(values)}"


def _equal(f: Figures) -> tuple[bool, str]:
    values = f["centre"].mean_of_means([n for n in f["centre"].counts if n > 34])
    gap = max(values.values()) - min(values.values())
    return gap < 5.0, f"largest less smallest mean above 34 matches: {gap:.1f} points; {_told(values)}"


def _diverge(f: Figures) -> tuple[bool, str]:
    values = f["north_east"].mean_of_means()
    best = min(values, key=values.__getitem__)
    rest = min(values[m] for m in ("1", "2", "5", "6"))
    return best == "4" and rest > 2.0 * values["4"], f"mean DCPE, {_told(values)}"


LESS_VARIED = _apart(
    lambda f: f["centre"].std_of_stds(), UNWEIGHTED, WEIGHTED, "spread of the scenes' deviations"
)
BIASED = _apart(
    lambda f: f["north"].mean_of_means([max(f["north"].counts)]),
    WEIGHTED,
    UNWEIGHTED,
    "means with the most matches",
)
CLAIMS = (
    Claim(32, "ahae", "centre: methods 1, 3, 5 vary less than 2, 4, 6", LESS_VARIED),
    Claim(32, "ahae", "centre: method 3 has the worst mean", _worst("centre", "mean_of_means")),
    Claim(32, "ahae", "centre: the others are similar", _similar),
    Claim(33, "ahae", "north: 4, 5, 6 are steadier with few matches", _steadier("north", "std_of_stds", 13)),
    Claim(33, "ahae", "north: unweighted 1, 3, 5 are biased", BIASED),
    Claim(34, "ahae", "north-east: method 3 has the worst mean", _worst("north_east", "mean_of_means")),
    Claim(34, "ahae", "north-east: method 3 has the worst deviation", _worst("north_east", "mean_of_stds")),
    Claim(34, "ahae", "north-east: method 4 steepens most below 34 matches", _steeper),
    Claim(34, "ahae", "north-east: the means of 4 and 6 spread more than in the north", _spread_grows),
    Claim(34, "ahae", "north-east: method 2's mean lies outside its box", _outside_box),
    Claim(37, "dcpe", "centre: all spreads stay below 5 with many matches", _small),
    Claim(37, "dcpe", "centre: 5 and 6 vary least below 13 matches", _combined_best),
    Claim(37, "dcpe", "centre: all equal above 34 matches", _equal),
    Claim(38, "dcpe", "north: 4, 5, 6 are steadier", _steadier("north", "mean_of_stds", 10**6)),
    Claim(38, "dcpe", "north: method 2 is poor", _worst("north", "mean_of_means", "2")),
    Claim(39, "dcpe", "north-east: 1, 2, 5, 6 diverge, 4 is best", _diverge),
)


def _told(values: dict[str, float]) -> str:
    return ", ".join(f"{name}: {value:.1f}" for name, value in values.items())
