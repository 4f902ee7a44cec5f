"""Names that an attacker would choose: the same 300 in every run."""

import random

CANARY = "PWNED"
PIECES = (
    f'*/ __attribute__((constructor)) void f(void) {{ system("touch {CANARY}"); }} /*',
    f"*/\nint {CANARY};\n/*",
    f"$(touch {CANARY})", f"`touch {CANARY}`", f"; touch {CANARY} #", f"\\\n#error {CANARY}\n",
    "??/", "*", "/", "//", "/*",
    '=HYPERLINK("http://x.test","y")', "=1+1", "+1+1", "-2+3", "@SUM(A1:A9)", "\t=1+1", "=cmd|' /C calc'!A0",
    "<script>alert(1)</script>", '"><img src=x onerror=alert(1)>', "</title>", "]]>", "<!--", "&lt;",
    "' onmouseover='x",
    "\x1b[2J", "\x1b]0;title\x07", "\x1b]8;;http://x.test\x07", "\r", "\n", "\0", "\x7f", "\x9b2J", "\u202e",
    "\u2028",
    "\n[inputs]\n", '"\n"x" = 1 #', '"""', "'''", "\\", "\\u0000", '"', "'", ",", ";", "a.b", "#", "[bold]", "[/]",
    "[link=http://x.test]", f"../../../{CANARY}", f"/tmp/{CANARY}", "..\\..\\x", "CON", "C:", "~", "%s%n", "{0}",
    "{x!r}",
    "$x^2$", "$\\frac{$", "$$", "@TITLE@", "@DATA@", "@SCRIPT@", "__import__('os')", "ä", "ß", "温度", "😀", "Ω",
    "x" * 300,
    "machine/field", "![](http://x.test/a.png)", "|", "`", "nan", "1e999", "true", "null", " ",
)  # fmt: skip


def hostile_names(count: int = 300) -> list[str]:
    """Each piece alone, then two or three of them around letters; all different."""
    chance, names = random.Random(1), dict.fromkeys(PIECES)
    while len(names) < count:
        names[chance.choice(("", "x", "T ")).join(chance.choices(PIECES, k=chance.choice((2, 2, 3))))] = None
    return list(names)[:count]
