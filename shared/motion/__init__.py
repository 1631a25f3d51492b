"""How a robot moved from one moment to another: composed, integrated, reckoned."""
