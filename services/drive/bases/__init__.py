"""From a course to a velocity, by what the base can do: one file for each base that cannot roll sideways."""
