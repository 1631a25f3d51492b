"""Colours of series that stay apart for colour-blind readers (Okabe and Ito 2008), and their markers."""

SERIES = ("#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#000000")
MARKERS = "osD^vP*"
