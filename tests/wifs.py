"""A weaving draft for the tests of the page: plain weave, on two shafts."""

WIF = """[WIF]
Version=1.1
[WEAVING]
Shafts=2
Treadles=2
[WARP]
Threads=4
[WEFT]
Threads=4
[TIEUP]
1=1
2=2
[THREADING]
1=1
2=2
3=1
4=2
[TREADLING]
1=1
2=2
3=1
4=2
"""
