"""The way of one frame: surfaces, shadows, estimate, filters, lighting, composition."""
