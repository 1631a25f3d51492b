"""What changed between two visits: `topnav study changes`, and rounds of the mission inspect."""
