"""Traffic classes of the guides."""

# (density [1/m²], persons on the deck [-]), of which each class gives one: HiVoSS (2008), traffic classes
TRAFFIC_CLASSES: dict[str, tuple[float | None, int | None]] = {
    "TC1": (None, 15), "TC2": (0.2, None), "TC3": (0.5, None), "TC4": (1.0, None), "TC5": (1.5, None)}
