"""In notebooks: the scene in 3D, sliders, and the pictures that stay when nobody answers."""
