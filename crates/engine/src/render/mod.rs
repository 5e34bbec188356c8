//! Pictures of a world: first-person colour, depth and labels with the status bar, and the top-down map.
