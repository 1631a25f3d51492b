"""Where the rooms of a world are and how one gets from one to the next: a file for each layout."""
