"""Do linear verdicts come true in MuJoCo?"""
