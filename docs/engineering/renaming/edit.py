"""Carry out a plan of renames: code, texts, files, and the repair of layout."""
import ast, collections, io, json, pathlib, re, subprocess, tokenize
TOPS = ("app", "core", "drivers", "resources", "tests")
TEXTS = (".md", ".cfg", ".toml", ".ts", ".csv", ".sh", ".yaml", ".yml", ".txt", ".html", ".svg")
LIMIT = 110

def base_name(k):
    return k[k.index("(") + 1:-1] if k.endswith(")") else k.rpartition(".")[2]

class Editor:
    def __init__(self, tree, facts, plan):
        self.tree, self.f, self.plan = tree, facts, plan
        self.rename = {}           # key -> new
        for root, (new, old, _) in plan.new.items():
            for k in plan.members_of.get(root) or {root}: self.rename[k] = new
        self.mod_new = {}
        for k in self.rename:
            if k in facts["mods"]: self.mod_new[k] = k.rpartition(".")[0] + "." + self.rename[k]
        # unambiguous names over the whole repository
        by = collections.defaultdict(set)
        for file, rs in facts["refs"].items():
            for r in rs: by[r[1]].update(self.rename.get(k) if base_name(k) == r[1] else None for k in r[2])
        self.unique = {old: next(iter(n)) for old, n in by.items() if len(n) == 1 and None not in n}
        self.classes = collections.defaultdict(set)
        for c in facts["class_info"]: self.classes[c.rpartition(".")[2]].add(c)
        self.log = []

    def run(self):
        self.paths()
        n = 0
        for file in self.f["files"]: n += self.python(file)
        out = subprocess.run(["git", "ls-files", "-z"], cwd=self.tree, capture_output=True, text=True, check=True).stdout
        for p in out.split("\0"):
            if p.endswith(TEXTS) or p.startswith(".ci/") or p.startswith(".pre-commit"): self.text(p)
        self.move()
        print(f"{n} places edited, {len(self.mod_new)} modules moved", flush=True)
        self.layout()
        for x in self.log[:60]: print("  ", x)

    # ---- dotted and file names in texts
    def paths(self):
        self.suffix = {}
        for old, new in self.mod_new.items():
            f = self.f["mods"][old]; parts = f.split("/")
            nf = "/".join(parts[:-1] + [new.rpartition(".")[2] + ".py"])
            for i in range(len(parts)):
                s = "/".join(parts[i:]); same = [x for x in self.f["files"] if x == s or x.endswith("/" + s)]
                if all(self.modname(x) in self.mod_new for x in same) and len({self.mod_new[self.modname(x)].rpartition(".")[2] for x in same}) == 1:
                    self.suffix[s] = "/".join(nf.split("/")[i:])
        self.dotted_re = re.compile(r"(?<![\w./])(?:app|core|drivers|resources|tests)(?:\.\w+)+")
        self.file_re = re.compile(r"(?<![\w.-])(?:[\w.-]+/)*\w+\.py\b")

    @staticmethod
    def modname(file):
        p = file[:-3].split("/")
        return ".".join(p[:-1] if p[-1] == "__init__" else p)

    def dotted(self, m):
        parts = m[0].split("."); mods = self.f["mods"]; pk = self.f["packages"]
        out = [parts[0]]; full = parts[0]; i = 1
        while i < len(parts) and (full + "." + parts[i] in mods or full + "." + parts[i] in pk):
            full += "." + parts[i]
            out.append(self.mod_new[full].rpartition(".")[2] if full in self.mod_new else parts[i]); i += 1
        owner = full
        if owner in mods:
            while i < len(parts):
                k = None
                for b in self.f["bases"].get(owner, [owner]):
                    if f"{b}.{parts[i]}" in self.rename or f"{b}.{parts[i]}" in self.plan.known: k = f"{b}.{parts[i]}"; break
                if k is None and f"{owner}.{parts[i]}" in self.f["reexports"]:
                    k = self.f["reexports"][f"{owner}.{parts[i]}"]
                    if base_name(k) != parts[i]: break
                if k is None: break
                out.append(self.rename.get(k, parts[i])); owner = k; i += 1
        return ".".join(out + parts[i:])

    def file_name(self, m):
        parts = m[0].split("/")
        for i in range(len(parts)):
            s = "/".join(parts[i:])
            if s in self.suffix: return "/".join(parts[:i] + [self.suffix[s]])
        return m[0]

    def handler(self, m):
        full = "core.interpreter.omniturn." + m[1]
        if full not in self.f["mods"]: return m[0]
        new = self.dotted(re.match(r"[\w.]+", full + "." + m[2]))
        n = len(self.mod_new.get(full, full).split("."))
        return ".".join(new.split(".")[3:n]) + ":" + ".".join(new.split(".")[n:])

    def in_text(self, s):
        if ":" in s: s = re.sub(r"(?<![\w.:])([a-z][\w.]*):([A-Za-z_][\w.]*)", self.handler, s)
        s = self.dotted_re.sub(self.dotted, s)
        if self.suffix and ".py" in s: s = self.file_re.sub(self.file_name, s)
        return s

    # ---- Python files
    def python(self, file):
        raw = (self.tree / file).read_bytes()
        edits = {}
        local = collections.defaultdict(set)     # names of this file: old -> new names
        lines_of = collections.defaultdict(list)
        for o, name, keys, kind, scope, line in self.f["refs"].get(file, ()):
            news = {self.rename.get(k) if base_name(k) == name else None for k in keys}
            local[name] |= news; lines_of[name].append((line, news))
            if news == {None}: continue
            if len(news) != 1: self.log.append(f"mixed {file}:{line} {name} {keys}"); continue
            new = news.pop()
            b = name.encode()
            if raw[o:o + len(b)] != b: self.log.append(f"position {file}:{line} {name}"); continue
            edits[o] = (o + len(b), new.encode())
        n = len(edits)
        text = raw.decode()
        self.tree_ast = tree = ast.parse(raw)
        starts = [0]
        for m in re.finditer(rb"\n", raw): starts.append(m.end())
        docs = []                              # (start, end, function range)
        ranges = []
        for node in ast.walk(tree):
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)): ranges.append((node.lineno, node.end_lineno))
            body = getattr(node, "body", None)
            if isinstance(body, list):
                for st in body:
                    if isinstance(st, ast.Expr) and isinstance(st.value, ast.Constant) and isinstance(st.value.value, str): docs.append((starts[st.lineno - 1] + st.col_offset, starts[st.end_lineno - 1] + st.end_col_offset))
        spans = []; docset = set(docs)
        decoded = text.split("\n")
        def off(line, col):
            return starts[line - 1] + len(decoded[line - 1][:col].encode())
        for tok in tokenize.generate_tokens(io.StringIO(text).readline):
            if tok.type == tokenize.COMMENT: spans.append((off(*tok.start), off(*tok.end), True, tok.start[0]))
            elif tok.type in (tokenize.STRING, getattr(tokenize, "FSTRING_MIDDLE", -1)):
                a, b = off(*tok.start), off(*tok.end)
                if tok.type != tokenize.STRING and raw[a:b].decode(errors="replace") != tok.string: continue
                spans.append((a, b, any(x <= a and b <= y for x, y in docset), tok.start[0]))
        ranges.sort()
        def inner(line):
            best = None
            for a, b in ranges:
                if a <= line <= b and (best is None or a >= best[0]): best = (a, b)
            return best
        def new_of(word, line):
            at = inner(line)
            if at:
                near = set()
                for l, news in lines_of.get(word, ()):
                    if at[0] <= l <= at[1]: near |= news
                if near: return next(iter(near)) if len(near) == 1 else None
            news = local.get(word)
            if news: return next(iter(news)) if len(news) == 1 else None
            return self.unique.get(word) if "_" in word.strip("_") else None
        for a, b, doc, line in spans:
            if any(a <= o < b for o in edits) and not doc: continue
            old = raw[a:b].decode()
            new = self.in_text(old)
            if doc:
                base = line
                def tick(m):
                    ln = line + new.count("\n", 0, m.start())
                    return "``" + re.sub(r"(?<![\w-])[A-Za-z_]\w*(?![\w-])", lambda w: new_of(w[0], ln) or w[0], m[1]) + "``"
                new2 = re.sub(r"``([\w.()*, =]+)``", tick, new)
                new = re.sub(r"(?<![\w./`-])[A-Za-z_]\w*_\w+(?![\w/`-]|\.py)", lambda w: new_of(w[0], line) or w[0], new2)
            elif old[1:-1] in self.f["scanned"] and any(p[0] == file for p in self.f["scanned"][old[1:-1]]) and re.fullmatch(r"['\"]\w+['\"]", old) and old[1:-1] in self.unique:
                new = old[0] + self.unique[old[1:-1]] + old[0]
            elif file.startswith("tests/") and not doc:
                m = re.search(r"(?<![\w.])([A-Z][a-z]\w+)\.$", old)   # the beginning of f"Class.{member}"
                if m and m[1] in self.unique and len(self.classes.get(m[1], ())) == 1: new = old[:m.start(1)] + self.unique[m[1]] + "."
                elif b"rglob(\"*.py\")" in raw and re.search(r"\(\w+(\|\w+)+\)", old):   # a pattern that finds names in sources
                    new = re.sub(r"(?<![\w\\])[A-Za-z_]\w{3,}", lambda w: self.unique.get(w[0], w[0]), old)
            if new != old: edits[a] = (b, new.encode())
        if not edits: return 0
        out = []; last = 0
        for o in sorted(edits):
            if o < last: continue
            out += [raw[last:o], edits[o][1]]; last = edits[o][0]
        out.append(raw[last:])
        (self.tree / file).write_bytes(b"".join(out))
        return n

    def text(self, p):
        path = self.tree / p
        try: old = path.read_text(encoding="utf-8")
        except (UnicodeDecodeError, FileNotFoundError): return
        new = self.in_text(old)
        if p in ("pyproject.toml", "setup.cfg"):
            for k, n in self.mod_new.items():
                a, b = k.split("."), n.rpartition(".")[2]
                new = re.sub(rf"(?<![\w]){a[-2]}/{a[-1]}(?![\w])", f"{a[-2]}/{b}", new)
                new = re.sub(rf"(?<![\w/]){a[-1]}(?=[,}}][^\n]*\.py\")", b, new) if f"{a[-2]}" in new and p == "pyproject.toml" else new
                if k.startswith("app.extras."): new = re.sub(rf"app\.extras\.\*\.{a[-1]}\b", f"app.extras.*.{b}", new)
        if p.endswith(".md"):
            def code(m):
                s = m[1]
                def cls(w):
                    cs = self.classes.get(w[1], ())
                    if len(cs) != 1: return w[0]
                    c = next(iter(cs)); k = next((f"{b}.{w[2]}" for b in self.f["bases"].get(c, [c]) if f"{b}.{w[2]}" in self.rename), None)
                    return f"{self.rename.get(c, w[1])}.{self.rename[k] if k else w[2]}"
                t = re.sub(r"(?<![\w.])([A-Z]\w*)\.(\w+)", cls, s)
                if t == s and re.fullmatch(r"[A-Za-z_]\w*(\(\))?", s):
                    name = s.removesuffix("()")
                    if name in self.unique and ("_" in name or name[:1].isupper() and name[1:2].islower() and len(self.classes.get(name, ())) == 1) and name not in self.f["strings"]: t = s.replace(name, self.unique[name])
                return "`" + t + "`"
            new = re.sub(r"(?<!`)`([^`\n]+)`(?!`)", code, new)
        if new != old: path.write_text(new, encoding="utf-8")

    def move(self):
        for old, new in self.mod_new.items():
            f = self.f["mods"][old]
            to = str(pathlib.Path(f).with_name(new.rpartition(".")[2] + ".py"))
            subprocess.run(["git", "mv", f, to], cwd=self.tree, check=True)

    # ---- layout
    def ruff(self, *args):
        return subprocess.run([str(self.tree / ".venv/bin/ruff"), *args], cwd=self.tree, capture_output=True, text=True)

    def layout(self):
        self.ruff("check", "--select", "I,RUF022,RUF023,PLC0414", "--fix", "--unsafe-fixes", "-q", ".")
        r = self.ruff("format", "-q", "."); print(r.stderr[:2000], end="")
        for _ in range(6):
            r = self.ruff("check", "--select", "E501", "--output-format", "json", ".")
            found = json.loads(r.stdout or "[]")
            if not found: break
            by = collections.defaultdict(list)
            for x in found: by[x["filename"]].append(x["location"]["row"])
            for file, rows in by.items(): self.shorten(pathlib.Path(file), sorted(set(rows), reverse=True))
            self.ruff("format", "-q", ".")
        r = self.ruff("check", "--select", "E501", "--output-format", "concise", "."); print("long lines left:", r.stdout.strip()[:3000])
        long = []
        for f in subprocess.run(["git", "ls-files", "*.py"], cwd=self.tree, capture_output=True, text=True).stdout.split():
            p = self.tree / f
            if p.exists():
                n = p.read_bytes().count(b"\n")
                if n > 500: long.append(f"{f} {n}")
        print("files over 500 lines:", "; ".join(long))

    def shorten(self, path, rows):
        text = path.read_text(encoding="utf-8"); lines = text.split("\n")
        toks = []
        try: toks = list(tokenize.generate_tokens(io.StringIO(text).readline))
        except (tokenize.TokenError, SyntaxError, IndentationError): return
        depth = 0; at = collections.defaultdict(list); doc = {}
        prev = None; stack = []
        for t in toks:
            if t.type == tokenize.OP and t.string in "([{": depth += 1
            if t.type == tokenize.OP and t.string in ")]}": depth -= 1
            if t.type == getattr(tokenize, "FSTRING_START", -1): stack.append((t, depth))
            if t.type == getattr(tokenize, "FSTRING_END", -1):
                s, d = stack.pop()
                if s.start[0] == t.end[0]: at[s.start[0]].append(("str", s.start[1], t.end[1], d, True))
                else:
                    for l in range(s.start[0], t.end[0] + 1): doc[l] = True
            if t.type == tokenize.STRING:
                if t.start[0] != t.end[0] or t.string.startswith(('"""', "'''")):
                    for l in range(t.start[0], t.end[0] + 1): doc[l] = True
                elif not stack: at[t.start[0]].append(("str", t.start[1], t.end[1], depth, False))
            if t.type == tokenize.COMMENT: at[t.start[0]].append(("com", t.start[1], t.end[1], depth, False))
        off = set(); state = False
        for i, l in enumerate(lines, 1):
            if re.match(r"\s*# fmt: off", l): state = True
            elif re.match(r"\s*# fmt: on", l): state = False
            if state: off.add(i)
        commas = collections.defaultdict(list); d = 0; end_of = {}; first = None
        for t in toks:
            if t.type == tokenize.OP and t.string in "([{": d += 1
            elif t.type == tokenize.OP and t.string in ")]}": d -= 1
            elif t.type == tokenize.OP and t.string == "," and d > 0 and not stack: commas[t.start[0]].append(t.end[1])
            if first is None and t.type not in (tokenize.NL, tokenize.COMMENT, tokenize.INDENT, tokenize.DEDENT): first = t.start[0]
            if t.type == tokenize.NEWLINE:
                for l in range(first, t.end[0] + 1): end_of[l] = t.start[0]
                first = None
        for row in rows:
            last = end_of.get(row)
            if last and "# fmt: skip" in lines[last - 1]:
                lines[last - 1] = re.sub(r"\s*# fmt: skip", "", lines[last - 1]); continue
            if row in off and not doc.get(row):
                line = lines[row - 1]
                cut = [c for c in commas[row] if c <= LIMIT and line[c:].strip() and c > 30]
                if cut:
                    ind = line[:len(line) - len(line.lstrip())] + ("    " if line.lstrip()[:1] not in "'\"" and not re.match(r"\s*\w+=", line) else "")
                    lines[row - 1:row] = [line[:cut[-1]], ind + line[cut[-1]:].strip()]; continue
            line = lines[row - 1]; indent = line[:len(line) - len(line.lstrip())]
            com = next((x for x in at[row] if x[0] == "com"), None)
            if com and "fmt:" not in line and "noqa" not in line and "type:" not in line:
                body = line[com[1]:]; code = line[:com[1]].rstrip()
                out = []
                words = body.split(" "); cur = ""
                for w in words:
                    if cur and len(indent) + len(cur) + 1 + len(w) > LIMIT - 4: out.append(indent + cur); cur = "# " + w
                    else: cur = f"{cur} {w}" if cur else w
                out.append(indent + cur)
                lines[row - 1:row] = out + ([code] if code.strip() else []); continue
            if doc.get(row) and not at[row]:
                cut = line.rfind(" ", len(indent) + 20, LIMIT)
                # an opening of a docstring on one line
                if cut > 0:
                    head, tail = line[:cut].rstrip(), line[cut + 1:]
                    nxt = lines[row] if row < len(lines) else ""
                    item = re.match(r"\s*([-*]|\d+\.)\s", line)
                    if doc.get(row + 1) and nxt.strip() and not re.match(r"\s*([-*]|\d+\.|\"\"\"|\w+:\s)", nxt) and nxt[:len(nxt) - len(nxt.lstrip())] == indent and not item and '"""' not in tail and len(indent + tail + " " + nxt.strip()) < 400:
                        lines[row - 1:row + 1] = [head, indent + tail + " " + nxt.strip()]
                    else:
                        if line.lstrip().startswith(('"""', "'''")) and tail.endswith('"""') and '"""' not in head.lstrip()[3:]: 
                            lines[row - 1:row] = [head, indent + tail[:-3].rstrip(), indent + '"""']
                        else: lines[row - 1:row] = [head, indent + ("  " if item else "") + tail]
                continue
            ss = [x for x in at[row] if x[0] == "str"]
            if ss:
                x = max(ss, key=lambda y: y[2] - y[1])
                lit = line[x[1]:x[2]]
                m = re.match(r"([a-zA-Z]*)(['\"])", lit)
                if m and len(lit) > 24:
                    pre, q = m[1], m[2]
                    limit = max(20, min(len(lit) - 10, LIMIT - x[1] - 4))
                    best = None; d = 0
                    for i, ch in enumerate(lit):
                        if x[4] and ch == "{": d += 1
                        if x[4] and ch == "}": d -= 1
                        if ch == " " and d == 0 and i < limit and i > len(pre) + 2: best = i + 1
                    if not best and x[4]:
                        d = 0
                        for i, ch in enumerate(lit):
                            if ch == "{" and d == 0 and len(pre) + 2 < i < limit and lit[i + 1:i + 2] != "{" and lit[i - 1] != "{": best = i
                            d += (ch == "{") - (ch == "}")
                    if best:
                        new = lit[:best] + q + " " + pre + q + lit[best:]
                        if x[3] == 0: new = "(" + new + ")"
                        lines[row - 1] = line[:x[1]] + new + line[x[2]:]
        new = "\n".join(lines)
        try: ast.parse(new)
        except SyntaxError: return
        path.write_text(new, encoding="utf-8")
