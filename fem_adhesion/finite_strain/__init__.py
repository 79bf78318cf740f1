"""The neo-Hookean sphere: material, body, surface law on the deformed surface, curve and events."""
