"""The one telling of a result: a sheet of facts, tables and answers, and the media that render any sheet.

Knows nothing of robots: numbers and units as people read them, text, HTML, and plain numbers for JSON.
"""
