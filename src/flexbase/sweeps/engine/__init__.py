"""Questions (a formula, or asked pose by pose), the one runner of them, and who runs its blocks."""
