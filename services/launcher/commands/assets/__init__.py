"""Commands about files that a stack uses: worlds and weights."""
