"""One file a result: how it is drawn."""
