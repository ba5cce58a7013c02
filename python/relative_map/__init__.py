"""Maps of relative_map in Python: `lanes` has numpy arrays of a MapMsg, `bags` reads drives, `pictures` draws them."""
