"""Broken input, odd command lines, kills and two runs at once: what ``make fuzz`` puts the command through."""
