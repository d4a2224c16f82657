"""Words and groups of options that commands share."""
