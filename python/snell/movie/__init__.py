"""From the frames of a sweep to a contact sheet and movies."""
