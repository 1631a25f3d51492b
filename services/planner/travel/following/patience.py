"""How long a robot goes on towards a waypoint that does not show, come nearer or let it past."""

import math

STUCK_STEPS = 35
"""Steps without coming closer after which no progress is made; chosen: 4.2 m at 0.12 m a step, further than
the way round any one piece of furniture."""

CLOSER = 0.95
"""Share of the least disparity so far that counts as closer, as do matches the other way round: along a
corridor disparity tells little. Chosen: one step of 0.12 m from 2.4 m away."""

WAITING_STEPS = 8
"""Steps at a waypoint after which the next one should have shown; chosen: 2.4 s, in which a person has
passed."""

NEAREST_STEPS = 8
"""Steps without coming closer after which a spot within `near_rad` is as near as obstacles allow; chosen: 2.4
s."""

BLIND_FRAMES = 40
"""Frames of a path in which a waypoint or goal is headed for that does not show; chosen: 4.8 m in a room,
further than any picture that is located in the map lies from its node."""


class Patience:
    """Counts frames, each by its share of a whole step: turns on the spot cost little patience.

    Attributes:
        unseen_frames: since the waypoint was last seen.
    """

    def __init__(self) -> None:
        self.unseen_frames = 0.0
        self._share = 1.0
        self._best_rad, self._best_s = math.inf, 0
        self._stale = self._waiting = self._blind_frames = 0.0

    @property
    def waits(self) -> bool:
        """Whether the robot stands at a waypoint and waits for the next one to show."""
        return self._waiting > 0.0

    @property
    def has_waited_too_long(self) -> bool:
        """Whether the next waypoint should have shown by now: what leads there is shut."""
        return self._waiting > WAITING_STEPS

    def begin_frame(self, share: float) -> None:
        """The next frame; `share` of a whole step."""
        self._share = share

    def aim_anew(self) -> None:
        """Another waypoint is the present one, of which no progress is known yet."""
        self._best_rad, self._best_s, self._stale = math.inf, 0, 0.0

    def stand(self, standing: bool) -> None:
        """Whether the robot stands at a waypoint from which it has to go on."""
        self._waiting = self._waiting + self._share if standing else 0.0

    def see(self) -> None:
        """The waypoint is seen."""
        self.unseen_frames = 0.0

    def miss(self) -> None:
        """The waypoint is not seen."""
        self.unseen_frames += self._share

    def goes_on_blind(self) -> bool:
        """Count a frame in which the way leads by the map alone; False after so many."""
        self._blind_frames += self._share
        return self._blind_frames <= BLIND_FRAMES

    def makes_no_progress(self, disparity_rad: float, s_cv: int, near_end: bool) -> bool:
        """Count a frame in which the waypoint is seen.

        Args:
            disparity_rad: of the waypoint; the least so far is the nearest.
            s_cv: its similarity; the most so far is the nearest, too.
            near_end: what is that near to the end of a path need not come much nearer.
        """
        nearer, liker = disparity_rad < self._best_rad * CLOSER, s_cv * CLOSER > self._best_s
        self._best_rad = disparity_rad if nearer else self._best_rad
        self._best_s = s_cv if liker else self._best_s
        self._stale = 0.0 if nearer or liker else self._stale + self._share
        return self._stale > (NEAREST_STEPS if near_end else STUCK_STEPS)
