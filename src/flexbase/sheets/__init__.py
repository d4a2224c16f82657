"""The one telling of a result: a sheet of headings, facts, tables and answers, which every medium renders."""
