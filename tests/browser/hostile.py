"""An exercise that tries to run a script in students' browsers."""

# Each text calls `stolen` or loads a picture if a page takes it for markup, which a test notices.
SCRIPT = "<script>stolen('script')</script>"
PICTURE = "<img src=x onerror=\"stolen('picture')\">"
DRAWING = "<svg onload=\"stolen('drawing')\"><a href='javascript:stolen(1)'>q</a></svg>"
TURNED = "theta1 \u202e 1ateht \u2066 x"
BREAKOUT = (
    "</title></script></textarea>\" onmouseover=\"stolen('quote') --> ]]> ${stolen(3)} {{7*7}}"
)
LOADING = "<base href=//192.0.2.1><meta http-equiv=refresh content='0;url=javascript:stolen(4)'>"
FORMULA = r"$\href{javascript:stolen(5)}{x} \text{<img src=x onerror=stolen(6)>}$"
TEXTS = [
    SCRIPT,
    PICTURE,
    DRAWING,
    TURNED,
    "javascript:stolen('address')",
    "]]><math href='javascript:0'>",
]

HOSTILE_EXERCISE = f"""
title = '''Hostile {PICTURE} {BREAKOUT}'''
source = '''{SCRIPT} {DRAWING} {LOADING}'''
statement = '''
Read {SCRIPT} and {PICTURE}.

[a link](javascript:stolen(2)) and {DRAWING}

{LOADING} {BREAKOUT} {FORMULA}

{BREAKOUT}
'''

[robot]
structure = "RR"
joints = ["theta1", "theta2"]
convention = "standard"
table = [["a1", "0", "0", "theta1"], ["a2", "0", "0", "theta2"]]

[symbols]
a1 = {{ kind = "length", unit = "m", range = [0.3, 0.9], description = '''length {PICTURE}''' }}
a2 = {{ kind = "length", unit = "m", range = [0.3, 0.9], description = '''{DRAWING} {BREAKOUT}''' }}

[[parts]]
id = "table"
kind = "dh_table"
title = '''The table {PICTURE} {BREAKOUT}'''
prompt = '''Give it {SCRIPT}{DRAWING} {FORMULA} {LOADING}'''
points = 4
convention = "standard"
frames = "free"
"""
