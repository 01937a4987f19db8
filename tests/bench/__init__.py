"""ebz beside its peers: sizes, which are exact, and speeds, as ratios within one run."""
