"""What belongs into a room, by what it is used for: a public function for each use."""
