"""Collect facts on every name of a checkout: who refers to what, by types. Facts do not depend on a table."""
import ast, bisect, hashlib, os, pathlib, pickle, re, subprocess, sys, time, io, tokenize, builtins
TOPS = ("app", "core", "drivers", "resources", "tests")
BUILTINS = set(dir(builtins))
PRELOADED = None
ATTRS = {}
SKIP_ATTRS = {'node', 'info', 'definition', 'original_def', 'type', 'unanalyzed_type', 'fullname', 'method_type', 'method_types', 'expanded', 'def_var', 'names', 'line', 'column', 'end_line', 'end_column', 'name', 'type_vars', 'analyzed'}

def sources(tree):
    out = subprocess.run(["git", "ls-files", "-z", *TOPS], cwd=tree, capture_output=True, text=True, check=True).stdout
    return sorted(p for p in out.split("\0") if p.endswith(".py"))

def modname(path):
    parts = path[:-3].split("/")
    if parts[-1] == "__init__": parts.pop()
    return ".".join(parts)

def run_mypy(tree, files):
    from mypy import build
    from mypy.options import Options
    from mypy.config_parser import parse_config_file
    from mypy.modulefinder import BuildSource
    import mypy.main
    os.chdir(tree)
    options = Options()
    parse_config_file(options, lambda: None, "pyproject.toml", sys.stdout, sys.stderr)
    for k in ("strict",): pass
    options.check_untyped_defs = True
    options.export_types = True; options.preserve_asts = True; options.incremental = False
    options.cache_dir = os.devnull
    options.native_parser = False
    options.fine_grained_incremental = False
    options.python_executable = str(pathlib.Path(tree, ".venv/bin/python"))
    options.warn_unreachable = False
    options.namespace_packages = True
    options.explicit_package_bases = True
    options.show_traceback = True
    srcs = [BuildSource(f, modname(f), None) for f in files]
    t = time.time()
    result = build.build(srcs, options)
    print(f"mypy: {time.time()-t:.0f} s, {len(result.errors)} messages", flush=True)
    for e in result.errors[:15]: print("   ", e)
    return result

class Scope:
    __slots__ = ("kind", "parent", "bound", "index", "node", "key", "imports", "globals", "nonlocals", "params", "name", "first")
    def __init__(self, kind, parent, node, index):
        self.kind, self.parent, self.node, self.index = kind, parent, node, index
        self.bound = {}; self.imports = {}; self.globals = set(); self.nonlocals = set(); self.params = {}; self.key = None; self.name = ""; self.first = {}

class Collector:
    def __init__(self, tree):
        self.tree = tree; self.files = sources(tree)
        self.mods = {modname(f): f for f in self.files}
        self.packages = {}
        for f in self.files:
            parts = f.split("/")
            for i in range(1, len(parts)): self.packages.setdefault(".".join(parts[:i]), None)
        self.result = PRELOADED or run_mypy(tree, self.files)
        self.types = self.result.types
        self.infos = {}        # fullname -> TypeInfo of the repository
        self.funcs = {}        # (module, line) -> key of a function
        self.func_params = {}  # key -> list of parameter names
        self.func_kwargs = {}
        self.symbols = {}      # key -> (kind, file, line)
        self.refs = {}         # file -> list
        self.scopes = {}       # file -> list of (kind, parent, bound, key, start, end)
        self.uses = {}         # file -> {name: [(scope, resolved scope)]}
        self.strings = {}      # value -> list of (file, line, context)
        self.unresolved = {}   # attribute name -> first places
        self.unres_kw = {}
        self.reflected = {}    # class -> (reason, place)
        self.dynamic = {}      # class -> place: getattr with a computed name
        self.unions = []
        self.standin = {}      # names in SimpleNamespace / setattr on unknown
        self.patched = {}      # key -> place
        self.enum_named = {}; self.starred = {}; self.scanned = {}
        self.lookup_cache = {}
        self.member = {}; self.calls = {}; self.supers = {}; self.names_at = {}
        self.texts = {}

    # ---- mypy nodes by position
    def index_module(self, mod):
        member, calls, supers, names, classes = {}, {}, {}, {}, {}
        from mypy import nodes
        attrs_of = ATTRS
        seen = set(); stack = [self.result.files[mod]]
        while stack:
            o = stack.pop()
            if isinstance(o, (list, tuple)): stack.extend(o); continue
            if not isinstance(o, nodes.Node) or isinstance(o, (nodes.TypeInfo, nodes.Var)) or id(o) in seen: continue
            seen.add(id(o))
            if isinstance(o, nodes.NameExpr): names[o.line, o.column] = o
            elif isinstance(o, nodes.MemberExpr): member[o.end_line, o.end_column, o.name] = o
            elif isinstance(o, nodes.CallExpr): calls[o.line, o.column, o.end_line, o.end_column] = o
            elif isinstance(o, nodes.SuperExpr): supers[o.end_line, o.end_column, o.name] = o
            elif isinstance(o, nodes.Expression): calls[o.line, o.column, o.end_line, o.end_column] = o
            elif isinstance(o, nodes.ClassDef): classes[o.line, o.name] = o.info
            t = type(o)
            at = attrs_of.get(t)
            if at is None:
                at = attrs_of[t] = [n for n in dir(t) if not n.startswith("_") and n not in SKIP_ATTRS and type(getattr(t, n)).__name__ in ("getset_descriptor", "member_descriptor")]
            if isinstance(o, nodes.MypyFile): stack.append(o.defs); continue
            for n in at:
                try: v = getattr(o, n)
                except Exception: continue
                if v is not None and isinstance(v, (list, tuple, nodes.Node)): stack.append(v)
        return member, calls, supers, names, classes

    # ---- types
    def infos_of(self, t, depth=0):
        """TypeInfos whose instances (kind 'i') or which themselves (kind 'c') a type stands for; None in the list = Any."""
        from mypy import types as T
        from mypy.types import get_proper_type
        if t is None or depth > 8: return [None]
        t = get_proper_type(t)
        if isinstance(t, T.Instance):
            return [t.type]
        if isinstance(t, T.UnionType):
            out = []
            for x in t.items: out += self.infos_of(x, depth + 1)
            return out
        if isinstance(t, T.TupleType): return self.infos_of(t.partial_fallback, depth + 1)
        if isinstance(t, T.TypedDictType): return self.infos_of(t.fallback, depth + 1)
        if isinstance(t, T.LiteralType): return self.infos_of(t.fallback, depth + 1)
        if isinstance(t, (T.TypeVarType,)):
            if t.values:
                out = []
                for x in t.values: out += self.infos_of(x, depth + 1)
                return out
            return self.infos_of(t.upper_bound, depth + 1)
        if isinstance(t, T.FunctionLike):
            if t.is_type_obj(): return [t.type_object()]
            return [t.fallback.type] if isinstance(t.fallback, T.Instance) else []
        if isinstance(t, T.TypeType): return self.infos_of(t.item, depth + 1)
        if isinstance(t, (T.NoneType, T.UninhabitedType, T.DeletedType)): return []
        if isinstance(t, T.AnyType): return [None]
        if isinstance(t, T.PartialType): return [t.type] if t.type else [None]
        return []

    def member_keys(self, info, name):
        """Keys of the definitions of a member in a class, or () if it is foreign."""
        c = self.lookup_cache.get((info, name))
        if c is None:
            c = ()
            for base in info.mro:
                if name in base.names:
                    if self.own(base): c = (base.fullname + "." + name,)
                    break
            else:
                c = ("?",) if self.own(info) and not info.fallback_to_any and not info.get("__getattr__") else ()
            self.lookup_cache[info, name] = c
        return c

    def own(self, info):
        m = info.module_name
        return m in self.mods or m in self.packages

    def ftype(self, e, depth=0):
        """Type of an expression, also where mypy has none because it takes the code for unreachable."""
        from mypy import nodes as N, types as T
        t = self.types.get(e)
        if t is not None: return t
        if depth > 10: return None
        if isinstance(e, N.NameExpr) or isinstance(e, N.MemberExpr) and isinstance(e.node, (N.TypeInfo, N.FuncDef, N.Var, N.Decorator)) :
            n = e.node
            if isinstance(n, N.Var): return n.type
            if isinstance(n, N.TypeInfo): return T.TypeType(T.Instance(n, []))
            if isinstance(n, N.FuncDef): return n.type
            if isinstance(n, N.Decorator): return n.var.type
            if isinstance(n, N.OverloadedFuncDef): return n.type
            if isinstance(e, N.NameExpr): return None
        if isinstance(e, N.MemberExpr):
            for info in self.infos_of(self.ftype(e.expr, depth + 1)):
                if info is None: continue
                s = info.get(e.name)
                if s is None: continue
                n = s.node
                if isinstance(n, N.Var): return n.type
                if isinstance(n, N.FuncDef): return n.type
                if isinstance(n, N.Decorator):
                    t = n.var.type
                    if n.var.is_property and isinstance(t, T.CallableType): return t.ret_type
                    return t
                if isinstance(n, N.OverloadedFuncDef):
                    if n.is_property and isinstance(n.items[0], N.Decorator):
                        t = n.items[0].var.type
                        return t.ret_type if isinstance(t, T.CallableType) else t
                    return n.type
            return None
        if isinstance(e, N.CallExpr):
            t = self.ftype(e.callee, depth + 1)
            t = T.get_proper_type(t) if t is not None else None
            if isinstance(t, T.CallableType): return t.ret_type
            if isinstance(t, T.TypeType): return t.item
            if isinstance(t, T.Overloaded): return t.items[0].ret_type
            return None
        if isinstance(e, N.IndexExpr):
            t = self.ftype(e.base, depth + 1)
            t = T.get_proper_type(t) if t is not None else None
            if isinstance(t, T.Instance) and t.args: return t.args[-1]
            if isinstance(t, T.TupleType) and t.items: return T.UnionType.make_union(t.items)
            return None
        if isinstance(e, N.AwaitExpr): return None
        return None

    # ---- run
    def run(self):
        for mod, file in self.mods.items():
            self.load_text(file)
        # classes
        from mypy import nodes as N
        t0 = time.time()
        self.module_index = {}
        for mod in self.mods:
            self.module_index[mod] = self.index_module(mod)
            for info in self.module_index[mod][4].values():
                if info: self.infos[info.fullname] = info
        print(f"index {time.time()-t0:.0f} s, {len(self.infos)} classes", flush=True)
        self.walkers = {}
        for mod, file in self.mods.items():
            w = Walker(self, mod, file); self.walkers[mod] = w; w.bind()
        for w in self.walkers.values(): w.resolve()
        print(f"walk {time.time()-t0:.0f} s", flush=True)
        self.families()
        return self.facts()

    def load_text(self, file):
        self.texts[file] = pathlib.Path(self.tree, file).read_bytes()

    def families(self):
        from mypy.typestate import type_state
        ext = {}   # key -> foreign base
        self.members = {}; self.bases = {}
        for full, info in self.infos.items():
            names = {}
            for base in info.mro:
                own = self.own(base)
                for n in base.names:
                    if own or n not in ("__init__",): names.setdefault(n, []).append((base, own))
            self.members[full] = set(names)
            self.bases[full] = [b.fullname for b in info.mro]
            for n, defs in names.items():
                if n.startswith("__") and n.endswith("__"): continue
                if not any(o for _, o in defs): continue
                keys = [b.fullname + "." + n for b, o in defs if o]
                for k in keys[1:]: self.unions.append((keys[0], k, "override"))
                for b, o in defs:
                    if not o and b.fullname != "builtins.object": ext[keys[0]] = b.fullname
        self.external = ext
        # protocols
        att = type_state._attempted_protocols
        pairs = 0
        for left, rights in list(att.items()):
            li = self.infos.get(left)
            for right in rights:
                ri = self.infos.get(right)
                if ri is None:
                    # foreign protocol (e.g. SupportsWrite): its members stay
                    continue
                if left == right: continue
                names = [n for b in ri.mro if b.is_protocol for n in b.names if not (n.startswith("__") and n.endswith("__"))]
                if li is None: 
                    other = left
                    # foreign class used as our protocol: keep names
                    fi = self.foreign(left)
                    if fi is not None and names and all(fi.get(n) for n in names):
                        for n in names:
                            for k in self.member_keys(ri, n): ext[k] = left
                    continue
                if names and all(li.get(n) for n in names):
                    pairs += 1
                    for n in names:
                        a, b = self.member_keys(li, n), self.member_keys(ri, n)
                        if a and b: self.unions.append((a[0], b[0], "protocol"))
                        elif b: ext[b[0]] = left
                for n in ("__call__",):
                    pass
        print("protocol pairs", pairs, flush=True)

    def foreign(self, full):
        mod, _, name = full.rpartition(".")
        f = self.result.files.get(mod)
        if f and name in f.names:
            from mypy.nodes import TypeInfo
            n = f.names[name].node
            return n if isinstance(n, TypeInfo) else None
        return None

    def deepen(self):
        """asdict also writes the classes of the fields."""
        todo = [k for k, v in self.reflected.items() if any(w[0] == "asdict" for w in v)]; seen = set(todo)
        while todo:
            info = self.infos.get(todo.pop())
            if not info: continue
            for base in info.mro:
                if not self.own(base): continue
                for name, sy in base.names.items():
                    t = getattr(sy.node, "type", None)
                    for i in self.all_infos(t):
                        if self.own(i) and i.fullname not in seen and ("dataclass" in class_kind(i) or "namedtuple" in class_kind(i)):
                            seen.add(i.fullname); todo.append(i.fullname)
                            self.reflected.setdefault(i.fullname, []).append(("asdict", self.infos[info.fullname].fullname, 0))

    def all_infos(self, t, d=0):
        from mypy import types as T
        if t is None or d > 5: return []
        t = T.get_proper_type(t)
        out = [i for i in self.infos_of(t) if i is not None] if not isinstance(t, T.FunctionLike) else []
        if isinstance(t, T.Instance):
            for a in t.args: out += self.all_infos(a, d + 1)
        if isinstance(t, (T.UnionType, T.TupleType)):
            for a in t.items: out += self.all_infos(a, d + 1)
        return out

    def facts(self):
        self.deepen()
        self.reexports = {}
        for m, w in self.walkers.items():
            top = w.scopes[0]
            for name, how in top.bound.items():
                if how == "import":
                    t = w.target(top.imports[name][0])
                    if t: self.reexports[f"{m}.{name}"] = t
        subclasses = {}
        for full, bases in self.bases.items():
            for b in bases[1:]: subclasses.setdefault(b, set()).add(full)
        return dict(files=self.files, mods=self.mods, packages=set(self.packages), symbols=self.symbols, refs=self.refs,
            scopes={f: [(s.kind, s.parent.index if s.parent else -1, s.bound, s.key) for s in w.scopes] for f, w in ((w.file, w) for w in self.walkers.values())},
            uses=self.uses, strings=self.strings, unresolved=self.unresolved, unres_kw=self.unres_kw, reflected=self.reflected,
            dynamic=self.dynamic, unions=self.unions, standin=self.standin, patched=self.patched, enum_named=self.enum_named,
            members=self.members, bases=self.bases, subclasses=subclasses, external=self.external, func_params=self.func_params,
            class_info={full: class_kind(i) for full, i in self.infos.items()}, starred=self.starred, scanned=self.scanned, reexports=self.reexports)

def class_kind(info):
    kinds = set()
    if info.is_enum: kinds.add("enum")
    if info.is_named_tuple: kinds.add("namedtuple")
    if "dataclass" in info.metadata or "dataclass_tag" in info.metadata: kinds.add("dataclass")
    if info.typeddict_type is not None: kinds.add("typeddict")
    if info.is_protocol: kinds.add("protocol")
    if any(b.fullname in ("enum.StrEnum",) for b in info.mro): kinds.add("strenum")
    return kinds

FUNC = (ast.FunctionDef, ast.AsyncFunctionDef)
COMP = (ast.ListComp, ast.SetComp, ast.GeneratorExp, ast.DictComp)

class Walker:
    """One module: scopes, then references."""
    def __init__(self, c, mod, file):
        self.c, self.mod, self.file = c, mod, file
        self.raw = c.texts[file]
        self.tree = ast.parse(self.raw, feature_version=(3, 11))
        self.lines = [0]
        for m in re.finditer(rb"\n", self.raw): self.lines.append(m.end())
        self.member, self.calls, self.supers, self.names, self.classes = c.module_index[mod]
        self.scopes = []
        self.node_scope = {}
        self.refs = c.refs.setdefault(file, [])
        self.uses_ast = bool(re.search(rb"^(import (ast|inspect)|from (ast|inspect) import)\b", self.raw, re.M)) or b"__annotations__" in self.raw or b"each.type" in self.raw or file.startswith("resources/translations/")
        self.uses = c.uses.setdefault(file, {})
        self.docs = set()
        self.seen_strings = set()

    def off(self, line, col): return self.lines[line - 1] + col

    def new_scope(self, kind, parent, node):
        s = Scope(kind, parent, node, len(self.scopes)); self.scopes.append(s); self.node_scope[node] = s
        return s

    # ---------- pass 1: bindings
    def bind(self):
        s = self.new_scope("module", None, self.tree); s.key = self.mod
        self.bind_body(self.tree.body, s)
        for n, k in s.bound.items():
            if k != "import": self.c.symbols.setdefault(f"{self.mod}.{n}", ("global", self.file, 0))

    def add(self, scope, name, how, node=None):
        if name in scope.globals: 
            self.scopes[0].bound.setdefault(name, how); return
        if name in scope.nonlocals: return
        if scope.kind == "comp" and how == "walrus":
            while scope.kind == "comp": scope = scope.parent
        if scope.kind == "class" and node is not None: scope.first.setdefault(name, node.lineno)
        old = scope.bound.get(name)
        if old is None or old == "import": scope.bound[name] = how

    def bind_body(self, body, s):
        for st in body: self.bind_node(st, s)

    def prescan_globals(self, body, s):
        stack = list(body)
        while stack:
            n = stack.pop()
            if isinstance(n, ast.Global): s.globals.update(n.names)
            elif isinstance(n, ast.Nonlocal): s.nonlocals.update(n.names)
            elif isinstance(n, FUNC + (ast.ClassDef, ast.Lambda)): continue
            stack.extend(ast.iter_child_nodes(n))

    def bind_node(self, n, s):
        if isinstance(n, FUNC):
            self.add(s, n.name, "def", n)
            for d in n.decorator_list: self.bind_node(d, s)
            self.bind_args_outer(n.args, s)
            if n.returns: self.bind_node(n.returns, s)
            f = self.new_scope("function", s, n)
            f.key = (f"{s.key}.{n.name}" if s.kind in ("module", "class") else f"{s.key}.<{n.lineno}>.{n.name}")
            self.c.funcs[self.mod, n.lineno] = f.key
            a = n.args
            names = [x.arg for x in a.posonlyargs + a.args + a.kwonlyargs]
            self.c.func_params.setdefault(f.key, [])
            for x in names:
                if x not in self.c.func_params[f.key]: self.c.func_params[f.key].append(x)
            self.c.func_kwargs[f.key] = a.kwarg.arg if a.kwarg else None
            for x in a.posonlyargs + a.args + a.kwonlyargs + ([a.vararg] if a.vararg else []) + ([a.kwarg] if a.kwarg else []):
                f.bound[x.arg] = "param"; f.params[x.arg] = f"{f.key}({x.arg})"
            self.c.symbols.setdefault(f.key, ("def", self.file, n.lineno))
            self.prescan_globals(n.body, f)
            self.bind_body(n.body, f)
        elif isinstance(n, ast.Lambda):
            self.bind_args_outer(n.args, s)
            f = self.new_scope("function", s, n); f.key = f"{s.key}.<lambda{n.lineno}:{n.col_offset}>"
            a = n.args
            for x in a.posonlyargs + a.args + a.kwonlyargs + ([a.vararg] if a.vararg else []) + ([a.kwarg] if a.kwarg else []):
                f.bound[x.arg] = "param"; f.params[x.arg] = f"{f.key}({x.arg})"
            self.bind_node(n.body, f)
        elif isinstance(n, ast.ClassDef):
            self.add(s, n.name, "class")
            for x in n.decorator_list + n.bases: self.bind_node(x, s)
            for k in n.keywords: self.bind_node(k.value, s)
            k = self.new_scope("class", s, n)
            info = self.classes.get((n.lineno, n.name))
            k.key = info.fullname if info else f"{s.key}.{n.name}"
            self.c.symbols.setdefault(k.key, ("class", self.file, n.lineno))
            self.bind_body(n.body, k)
        elif isinstance(n, COMP):
            self.bind_node(n.generators[0].iter, s)
            k = self.new_scope("comp", s, n); k.key = s.key
            for i, g in enumerate(n.generators):
                self.bind_node(g.target, k)
                if i: self.bind_node(g.iter, k)
                for x in g.ifs: self.bind_node(x, k)
            for x in ([n.key, n.value] if isinstance(n, ast.DictComp) else [n.elt]): self.bind_node(x, k)
        elif isinstance(n, ast.Name):
            if isinstance(n.ctx, (ast.Store, ast.Del)): self.add(s, n.id, "assign", n)
        elif isinstance(n, ast.NamedExpr):
            self.add(s, n.target.id, "walrus"); self.bind_node(n.value, s)
        elif isinstance(n, ast.Import):
            for a in n.names:
                name = a.asname or a.name.split(".")[0]
                self.add(s, name, "import")
                s.imports.setdefault(name, []).append(a.name if a.asname else a.name.split(".")[0])
        elif isinstance(n, ast.ImportFrom):
            base = self.from_base(n)
            for a in n.names:
                name = a.asname or a.name
                self.add(s, name, "import")
                s.imports.setdefault(name, []).append(f"{base}.{a.name}")
        elif isinstance(n, ast.ExceptHandler):
            if n.name: self.add(s, n.name, "assign")
            for x in ast.iter_child_nodes(n): self.bind_node(x, s)
        elif isinstance(n, (ast.MatchAs, ast.MatchStar)):
            if n.name: self.add(s, n.name, "assign")
            for x in ast.iter_child_nodes(n): self.bind_node(x, s)
        elif isinstance(n, ast.MatchMapping):
            if n.rest: self.add(s, n.rest, "assign")
            for x in ast.iter_child_nodes(n): self.bind_node(x, s)
        else:
            for x in ast.iter_child_nodes(n): self.bind_node(x, s)

    def bind_args_outer(self, a, s):
        for x in a.defaults + [d for d in a.kw_defaults if d]: self.bind_node(x, s)
        for x in a.posonlyargs + a.args + a.kwonlyargs + ([a.vararg] if a.vararg else []) + ([a.kwarg] if a.kwarg else []):
            if x.annotation: self.bind_node(x.annotation, s)

    def from_base(self, n):
        if not n.level: return n.module or ""
        parts = self.mod.split(".")
        if not self.file.endswith("__init__.py"): parts = parts[:-1]
        parts = parts[:len(parts) - (n.level - 1)]
        return ".".join(parts + ([n.module] if n.module else []))

    # ---------- symbols
    def target(self, dotted, depth=0):
        """Follow an import to the key of what it names."""
        c = self.c
        if dotted in c.mods or dotted in c.packages: return dotted
        mod, _, name = dotted.rpartition(".")
        if mod not in c.mods or depth > 8: return None
        w = c.walkers[mod]; top = w.scopes[0]
        if name in top.bound and top.bound[name] != "import": return dotted
        if name in top.imports: return w.target(top.imports[name][0], depth + 1)
        return dotted if name in top.bound else None

    def lookup(self, name, s):
        """The scope in which a name is bound, or None."""
        first = True
        while s is not None:
            if s.kind != "class" or first:
                if name in s.globals: return self.scopes[0] if name in self.scopes[0].bound else None
                if name in s.bound: return s
            if s.kind != "comp": first = False
            s = s.parent
        return None

    def key_in(self, name, b):
        if b is None: return None
        if name in b.params: return b.params[name]
        if b.bound.get(name) == "import": return self.target(b.imports[name][0])
        if b.kind == "module":
            if name in b.imports and b.bound[name] == "import": return self.target(b.imports[name][0])
            return f"{self.mod}.{name}"
        if b.kind == "class":
            info = self.c.infos.get(b.key)
            return f"{b.key}.{name}"
        n = b.bound.get(name)
        if n in ("def", "class") and b.kind == "function":
            return f"L:{b.key}.{name}"
        return None

    def ref(self, line, col, name, keys, kind, scope, end=None, extra=None):
        """Record a reference at line, column (bytes)."""
        o = self.off(line, col)
        b = name.encode()
        if self.raw[o:o + len(b)] != b:
            self.c.unresolved.setdefault(name, []).append((self.file, line, "position " + kind))
            return
        self.refs.append((o, name, tuple(keys), kind, scope.index if scope else -1, line))

    # ---------- pass 2
    def resolve(self):
        self.mark_docstrings()
        self.body(self.tree.body, self.scopes[0])

    def mark_docstrings(self):
        for n in ast.walk(self.tree):
            b = getattr(n, "body", None)
            if isinstance(b, list):
                for st in b:
                    if isinstance(st, ast.Expr) and isinstance(st.value, ast.Constant) and isinstance(st.value.value, str): self.docs.add(st.value)

    def body(self, body, s):
        for st in body: self.visit(st, s)

    def use(self, name, s, b):
        self.uses.setdefault(name, []).append((s.index, b.index if b else -1))

    def def_pos(self, n):
        o = self.off(n.lineno, n.col_offset)
        m = re.compile(rb"(?:async\s+)?(?:def|class)\s+").match(self.raw, o)
        return n.lineno, n.col_offset + m.end() - o

    def name_ref(self, n, s, ann=False):
        b = self.lookup(n.id, s)
        if s.kind == "class" and b is s and isinstance(n.ctx, ast.Load) and n.lineno <= s.first.get(n.id, 0):
            outer = self.lookup(n.id, s.parent) if s.parent.kind != "class" else self.scopes[0] if n.id in self.scopes[0].bound else None
            if outer is not None or n.id in BUILTINS: b = outer
        self.use(n.id, s, b)
        k = self.key_in(n.id, b)
        if k and not k.startswith("L:"): self.ref(n.lineno, n.col_offset, n.id, (k,), "name", s, extra=b)

    def annotation(self, n, s):
        self.visit(n, s, ann=True)

    def visit(self, n, s, ann=False):
        m = getattr(self, "v_" + n.__class__.__name__, None)
        if m: m(n, s, ann)
        else:
            for x in ast.iter_child_nodes(n): self.visit(x, s, ann)

    def v_Name(self, n, s, ann): self.name_ref(n, s)

    def v_NamedExpr(self, n, s, ann):
        self.name_ref(n.target, s); self.visit(n.value, s)

    def v_FunctionDef(self, n, s, ann):
        for d in n.decorator_list: self.visit(d, s)
        self.args_outer(n.args, s)
        if n.returns: self.annotation(n.returns, s)
        line, col = self.def_pos(n)
        k = self.key_in(n.name, s if n.name not in s.globals else self.scopes[0])
        self.use(n.name, s, s)
        if k and not k.startswith("L:"): self.ref(line, col, n.name, (k,), "def", s)
        f = self.node_scope[n]
        self.args_inner(n.args, f)
        self.body(n.body, f)
        if s.kind == "class": self.param_family(n, s, f)
    v_AsyncFunctionDef = v_FunctionDef

    def param_family(self, n, s, f):
        info = self.c.infos.get(s.key)
        if not info: return
        for base in info.mro[1:]:
            if n.name in base.names:
                if self.c.own(base):
                    for p in f.params:
                        self.c.unions.append((f.params[p], f"{base.fullname}.{n.name}({p})", "param"))
                elif n.name not in ("__init__", "__new__"):
                    for p in f.params: self.c.patched.setdefault(f.params[p], ("overrides " + base.fullname,))

    def args_outer(self, a, s):
        for x in a.defaults + [d for d in a.kw_defaults if d]: self.visit(x, s)
        for x in a.posonlyargs + a.args + a.kwonlyargs + ([a.vararg] if a.vararg else []) + ([a.kwarg] if a.kwarg else []):
            if x.annotation: self.annotation(x.annotation, s)

    def args_inner(self, a, f):
        for x in a.posonlyargs + a.args + a.kwonlyargs + ([a.vararg] if a.vararg else []) + ([a.kwarg] if a.kwarg else []):
            self.ref(x.lineno, x.col_offset, x.arg, (f.params[x.arg],), "arg", f)

    def v_Lambda(self, n, s, ann):
        self.args_outer(n.args, s); f = self.node_scope[n]; self.args_inner(n.args, f); self.visit(n.body, f)

    def v_ClassDef(self, n, s, ann):
        for x in n.decorator_list + n.bases: self.visit(x, s)
        for k in n.keywords: self.visit(k.value, s)
        line, col = self.def_pos(n)
        k = self.key_in(n.name, s)
        self.use(n.name, s, s)
        if k and not k.startswith("L:"): self.ref(line, col, n.name, (k,), "def", s)
        scope = self.node_scope[n]
        for st in n.body:
            if isinstance(st, ast.Assign) and len(st.targets) == 1 and isinstance(st.targets[0], ast.Name) and st.targets[0].id in ("__slots__", "__match_args__"):
                info = self.c.infos.get(scope.key)
                for x in ast.walk(st.value):
                    if isinstance(x, ast.Constant) and isinstance(x.value, str) and info:
                        self.string_ref(x, self.c.member_keys(info, x.value), scope)
        for d in n.decorator_list:
            if isinstance(d, ast.Name) and d.id == "key_table": self.c.reflected.setdefault(scope.key, []).append(("key_table", self.file, n.lineno))
        info = self.c.infos.get(scope.key)
        if info is not None and info.typeddict_type is not None:
            for name in info.typeddict_type.items: self.c.strings.setdefault(name, []).append((self.file, n.lineno, "TypedDict"))
            self.c.reflected.setdefault(scope.key, []).append(("TypedDict", self.file, n.lineno))
        if info is not None and info.is_enum:
            for st in n.body:
                if isinstance(st, ast.Assign) and isinstance(st.value, ast.Call) and isinstance(st.value.func, (ast.Name, ast.Attribute)) and (getattr(st.value.func, "id", "") == "auto" or getattr(st.value.func, "attr", "") == "auto") and "strenum" in class_kind(info):
                    self.c.enum_named.setdefault(scope.key, (self.file, n.lineno, "auto()"))
        self.body(n.body, scope)

    def comp(self, n, s, ann):
        k = self.node_scope[n]
        self.visit(n.generators[0].iter, s)
        for i, g in enumerate(n.generators):
            self.visit(g.target, k)
            if i: self.visit(g.iter, k)
            for x in g.ifs: self.visit(x, k)
        for x in ([n.key, n.value] if isinstance(n, ast.DictComp) else [n.elt]): self.visit(x, k)
    v_ListComp = v_SetComp = v_GeneratorExp = v_DictComp = comp

    def v_AnnAssign(self, n, s, ann):
        self.annotation(n.annotation, s); self.visit(n.target, s)
        if n.value: self.visit(n.value, s)

    def v_Assign(self, n, s, ann):
        if s.kind == "module" and len(n.targets) == 1 and isinstance(n.targets[0], ast.Name) and n.targets[0].id == "__all__":
            for x in ast.walk(n.value):
                if isinstance(x, ast.Constant) and isinstance(x.value, str):
                    k = self.key_in(x.value, self.scopes[0] if x.value in self.scopes[0].bound else None)
                    if k: self.string_ref(x, (k,), s)
        for x in n.targets: self.visit(x, s)
        self.visit(n.value, s)

    def v_Import(self, n, s, ann):
        for a in n.names:
            self.dotted_ref(a.lineno, a.col_offset, a.name, s)
            if not a.asname: self.use(a.name.split(".")[0], s, s)

    def dotted_ref(self, line, col, dotted, s):
        parts = dotted.split(".")
        for i, p in enumerate(parts):
            full = ".".join(parts[:i + 1])
            if full in self.c.mods or full in self.c.packages: self.ref(line, col, p, (full,), "modpart", s)
            col += len(p) + 1

    def v_ImportFrom(self, n, s, ann):
        base = self.from_base(n)
        if base.split(".")[0] not in TOPS: return
        o = self.off(n.lineno, n.col_offset)
        m = re.compile(rb"from\s+(\.*)\s*").match(self.raw, o)
        if n.module and not n.level: self.dotted_ref(n.lineno, n.col_offset + m.end() - o, n.module, s)
        elif n.module:
            col = n.col_offset + m.end() - o; pre = base[:len(base) - len(n.module)]
            for i, p in enumerate(n.module.split(".")):
                full = pre + ".".join(n.module.split(".")[:i + 1])
                self.ref(n.lineno, col, p, (full,), "modpart", s); col += len(p) + 1
        for a in n.names:
            k = self.target(f"{base}.{a.name}")
            same = a.asname == a.name
            if k: self.ref(a.lineno, a.col_offset, a.name, (k,), "import" if not a.asname or same else "importas", s)
            if k and same: self.ref(a.end_lineno, a.end_col_offset - len(a.name.encode()), a.name, (k,), "import", s)

    def string_ref(self, x, keys, s):
        """Reference by a string constant that consists of a name."""
        if not keys: return
        o = self.off(x.lineno, x.col_offset)
        m = re.compile(rb"[rRuU]?('''|\"\"\"|'|\")").match(self.raw, o)
        if not m or x.end_lineno != x.lineno: return
        self.seen_strings.add(x)
        col = x.col_offset + m.end() - o
        self.ref(x.lineno, col, x.value.rpartition(".")[2], keys, "str", s) if "." not in x.value else None

    def v_Constant(self, n, s, ann):
        if isinstance(n.value, str):
            if n in self.docs or n in self.seen_strings: return
            if ann and n.lineno == n.end_lineno and re.fullmatch(r"[\w.\[\], |\"']+", n.value):
                o = self.off(n.lineno, n.col_offset)
                m = re.compile(rb"('''|\"\"\"|'|\")").match(self.raw, o)
                try: sub = ast.parse(n.value, mode="eval")
                except SyntaxError: sub = None
                if sub and m:
                    for x in ast.walk(sub):
                        if hasattr(x, "lineno"):
                            x.lineno = n.lineno; x.end_lineno = n.lineno
                            x.col_offset += n.col_offset + m.end() - o; x.end_col_offset += n.col_offset + m.end() - o
                    self.visit(sub.body, s, False); return
            if self.uses_ast and n.value.isidentifier(): self.c.scanned.setdefault(n.value, []).append((self.file, n.lineno))
            if len(n.value) < 200: self.c.strings.setdefault(n.value, []).append((self.file, n.lineno, "ann" if ann else ""))

    def v_Subscript(self, n, s, ann):
        if isinstance(n.value, (ast.Name, ast.Attribute)) and ann:
            name = n.value.id if isinstance(n.value, ast.Name) else n.value.attr
            self.visit(n.value, s, ann)
            if name == "Literal": self.visit(n.slice, s, False)
            else: self.visit(n.slice, s, True)
            return
        base = n.value.id if isinstance(n.value, ast.Name) else n.value.attr if isinstance(n.value, ast.Attribute) else ""
        if base in {"Callable", "Mapping", "Sequence", "dict", "list", "tuple", "set", "frozenset", "type", "Iterator", "Iterable", "Optional", "Union", "Generator", "Collection", "MutableMapping", "ClassVar", "Final"} and isinstance(n.ctx, ast.Load):
            self.visit(n.value, s); self.visit(n.slice, s, True); return
        # EnumClass["NAME"]
        for x in (n.value, n.slice): self.visit(x, s, ann)
        k = self.static_key(n.value, s)
        info = self.c.infos.get(k) if k else None
        if info and info.is_enum: self.c.enum_named.setdefault(k, (self.file, n.lineno, "index"))

    def static_key(self, n, s):
        """Key of a module, class or function that a chain of names denotes."""
        if isinstance(n, ast.Name):
            k = self.key_in(n.id, self.lookup(n.id, s))
            return k
        if isinstance(n, ast.Attribute):
            k = self.static_key(n.value, s)
            if k is None: return None
            if k in self.c.mods or k in self.c.packages: return self.target(f"{k}.{n.attr}")
            if k in self.c.infos:
                ks = self.c.member_keys(self.c.infos[k], n.attr)
                return ks[0] if ks else None
        return None

    def receiver_infos(self, n, s):
        """TypeInfos of an expression, by its own position; None in the list where it is Any or unknown."""
        k = self.static_key(n, s)
        if k and k in self.c.infos: return [self.c.infos[k]]
        e = self.expr_at(n)
        if e is None: return [None]
        return self.c.infos_of(self.c.ftype(e))

    def expr_at(self, n):
        if isinstance(n, ast.Name): return self.names.get((n.lineno, n.col_offset))
        if isinstance(n, ast.Attribute):
            return self.member.get((n.end_lineno, n.end_col_offset, n.attr)) or self.supers.get((n.end_lineno, n.end_col_offset, n.attr))
        return self.calls.get((n.lineno, n.col_offset, n.end_lineno, n.end_col_offset))

    def attr_keys(self, n, s):
        """Keys of an attribute access: (keys, known)."""
        c = self.c
        base = self.static_key(n.value, s)
        if base and (base in c.mods or base in c.packages):
            k = self.target(f"{base}.{n.attr}")
            return ((k,) if k else ()), True
        at = (n.end_lineno, n.end_col_offset, n.attr)
        o = self.supers.get(at)
        if o is not None and o.info:
            for b in o.info.mro[1:]:
                if n.attr in b.names: return ((f"{b.fullname}.{n.attr}",) if c.own(b) else ()), True
            return (), True
        if base and base in c.infos:
            ks = c.member_keys(c.infos[base], n.attr)
            if ks == ("?",):
                meta = c.infos[base].metaclass_type
                return (), True
            return ks, True
        o = self.member.get(at)
        if o is None: return (), self.foreign_static(n.value, s)
        t = c.types.get(o.expr)
        if t is None: t = c.ftype(o.expr)
        infos = c.infos_of(t)
        keys, known = [], True
        for i in infos:
            if i is None:
                if self.foreign_static(n.value, s): continue
                known = False; continue
            for k in c.member_keys(i, n.attr):
                if k != "?" and k not in keys: keys.append(k)
        return tuple(keys), known

    def foreign_static(self, n, s):
        """Whether a chain of names begins at a foreign module."""
        while isinstance(n, ast.Attribute): n = n.value
        if isinstance(n, ast.Name):
            b = self.lookup(n.id, s)
            if b is not None and b.bound.get(n.id) == "import": return self.target(b.imports[n.id][0]) is None
        return False

    def v_Attribute(self, n, s, ann):
        self.visit(n.value, s, ann)
        keys, known = self.attr_keys(n, s)
        if keys: self.ref(n.end_lineno, n.end_col_offset - len(n.attr.encode()), n.attr, keys, "attr", s)
        if not known and not (n.attr.startswith("__")):
            self.c.unresolved.setdefault(n.attr, []).append((self.file, n.end_lineno, "Any"))
        if n.attr in ("name", "_name_"):
            for i in self.receiver_infos(n.value, s):
                if i is not None and i.is_enum and self.c.own(i): self.c.enum_named.setdefault(i.fullname, (self.file, n.lineno, ".name"))
        if n.attr in ("_fields", "_asdict", "__dict__", "__annotations__", "__slots__", "__dataclass_fields__", "__match_args__", "_field_defaults", "__members__"):
            self.reflect(self.receiver_infos(n.value, s), n.attr, n)

    def reflect(self, infos, why, n, deep=False):
        for i in infos:
            if i is not None and self.c.own(i):
                self.c.reflected.setdefault(i.fullname, []).append((why, self.file, n.lineno))

    def v_MatchClass(self, n, s, ann):
        self.visit(n.cls, s)
        for p in n.patterns: self.visit(p, s)
        k = self.static_key(n.cls, s); info = self.c.infos.get(k)
        for name, p in zip(n.kwd_attrs, n.kwd_patterns):
            o = self.off(p.lineno, p.col_offset)
            m = re.search(rb"(\w+)\s*=\s*$", self.raw[max(0, o - 200):o])
            if m and info:
                o2 = max(0, o - 200) + m.start(1)
                line = bisect.bisect_right(self.lines, o2)
                ks = self.c.member_keys(info, name)
                if ks and ks != ("?",): self.ref(line, o2 - self.lines[line - 1], name, ks, "attr", s)
            self.visit(p, s)

    def v_MatchAs(self, n, s, ann):
        if n.pattern: self.visit(n.pattern, s)
        if n.name: self.use(n.name, s, self.lookup(n.name, s))
        self.late_bound(n, n.name, s)

    def late_bound(self, n, name, s):
        """A binding without a node of its own that binds a parameter or a global."""
        if not name: return
        b = self.lookup(name, s); k = self.key_in(name, b)
        if k and not k.startswith("L:"):
            seg = self.raw[self.off(n.lineno, n.col_offset):self.off(n.end_lineno, n.end_col_offset)]
            if isinstance(n, ast.MatchAs):
                m = re.search(rb"(?:^|\bas\s+)(" + name.encode() + rb")$", seg)
                if m:
                    o = self.off(n.lineno, n.col_offset) + m.start(1); line = bisect.bisect_right(self.lines, o)
                    self.ref(line, o - self.lines[line - 1], name, (k,), "name", s); return
            self.c.unresolved.setdefault(name, []).append((self.file, n.lineno, "binding"))

    def v_MatchStar(self, n, s, ann):
        if n.name: self.use(n.name, s, self.lookup(n.name, s)); self.late_bound(n, n.name, s)

    def v_ExceptHandler(self, n, s, ann):
        if n.type: self.visit(n.type, s)
        if n.name: self.use(n.name, s, self.lookup(n.name, s)); self.late_bound(n, n.name, s)
        self.body(n.body, s)

    def v_Global(self, n, s, ann):
        o = self.off(n.lineno, n.col_offset); seg = self.raw[o:self.off(n.end_lineno, n.end_col_offset)]
        for name in n.names:
            m = re.search(rb"\b" + name.encode() + rb"\b", seg[6:])
            if m: self.ref(n.lineno, n.col_offset + 6 + m.start(), name, (f"{self.mod}.{name}",), "name", s)
    def v_Nonlocal(self, n, s, ann):
        o = self.off(n.lineno, n.col_offset); seg = self.raw[o:self.off(n.end_lineno, n.end_col_offset)]
        for name in n.names:
            b = self.lookup(name, s.parent); k = self.key_in(name, b)
            m = re.search(rb"\b" + name.encode() + rb"\b", seg[8:])
            if m and k and not k.startswith("L:"): self.ref(n.lineno, n.col_offset + 8 + m.start(), name, (k,), "name", s)

    # ---------- calls
    def func_key_of_node(self, node):
        """Own keys of a mypy definition: functions, or classes through their constructor."""
        from mypy import nodes as N
        if isinstance(node, N.Decorator): return self.func_key_of_node(node.func)
        if isinstance(node, N.FuncDef):
            mod = None
            if node.info: mod = node.info.module_name
            elif node.fullname and "." in node.fullname:
                mod = node.fullname.rpartition(".")[0]
            for m in (mod, self.mod):
                k = self.c.funcs.get((m, node.line))
                if k and k.rpartition(".")[2] == node.name: return [k]
            return []
        if isinstance(node, N.OverloadedFuncDef):
            out = []
            for i in list(node.items) + ([node.impl] if node.impl else []): out += self.func_key_of_node(i)
            return out
        return []

    def callee_funcs(self, n, s, depth=0):
        """What a call calls: list of ('f', key of function) and ('c', TypeInfo); and whether it is all known."""
        from mypy import nodes as N, types as T
        c = self.c; out = []; known = True
        def of_info(i):
            out.append(("c", i))
        def of_type(t, d=0):
            nonlocal known
            if t is None or d > 6: known = False; return
            t = T.get_proper_type(t)
            if isinstance(t, T.CallableType):
                if t.is_type_obj(): of_info(t.type_object()); return
                if t.definition is not None:
                    ks = self.func_key_of_node(t.definition)
                    if ks: out.extend(("f", k) for k in ks)
                    elif not t.definition.fullname.split(".")[0] in TOPS: pass
                    else: known = False
                else: known = False
            elif isinstance(t, T.Overloaded):
                for i in t.items: of_type(i, d + 1)
            elif isinstance(t, T.UnionType):
                for i in t.items: of_type(i, d + 1)
            elif isinstance(t, T.TypeType):
                for i in c.infos_of(t.item):
                    if i is not None: of_info(i)
            elif isinstance(t, T.Instance) and t.type.fullname == "functools.partial":
                inner = t.extra_attrs.attrs.get("__mypy_partial") if t.extra_attrs else None
                if inner is not None: of_type(inner, d + 1)
                else: known = False
            elif isinstance(t, T.Instance):
                sy = t.type.get("__call__")
                if sy and sy.node: out.extend(("f", k) for k in self.func_key_of_node(sy.node))
            elif isinstance(t, T.TypeVarType): of_type(t.upper_bound, d + 1)
            elif isinstance(t, T.NoneType): pass
            else: known = False
        k = self.static_key(n, s)
        if k and depth < 4 and k not in c.infos and k not in c.func_params and k.rpartition(".")[0] in c.mods:
            w = c.walkers[k.rpartition(".")[0]]; v = w.partial_of(k.rpartition(".")[2])
            if v is not None: return w.callee_funcs(v, w.scopes[0], depth + 1)
        if k and k in c.infos: of_info(c.infos[k]); return out, True
        if k and k in c.func_params and not k.startswith("L:"): return [("f", k)], True
        if k and k.startswith("L:"):
            # local function or class
            b = self.lookup(n.id, s) if isinstance(n, ast.Name) else None
            for node, sc in self.node_scope.items():
                if sc.parent is b and getattr(node, "name", None) == n.id:
                    if sc.kind == "function": return [("f", sc.key)], True
                    if sc.kind == "class" and sc.key in c.infos: return [("c", c.infos[sc.key])], True
        e = self.expr_at(n)
        if isinstance(n, ast.Attribute):
            o = self.member.get((n.end_lineno, n.end_col_offset, n.attr))
            infos = []
            if o is not None: infos = c.infos_of(c.ftype(o.expr))
            so = self.supers.get((n.end_lineno, n.end_col_offset, n.attr))
            if so is not None and so.info:
                for b in so.info.mro[1:]:
                    if n.attr in b.names:
                        ks = self.func_key_of_node(b.names[n.attr].node); return [("f", x) for x in ks], True
                return [], True
            got = False
            for i in infos:
                if i is None: continue
                sy = i.get(n.attr)
                if sy and isinstance(sy.node, (N.FuncDef, N.Decorator, N.OverloadedFuncDef)) and not (isinstance(sy.node, N.Decorator) and sy.node.var.is_property):
                    ks = self.func_key_of_node(sy.node); out += [("f", x) for x in ks]; got = True
            if got: return out, True
        if e is None: return out, self.foreign_static(n, s)
        of_type(c.ftype(e))
        return out, known

    def partial_of(self, name):
        """Function of a global ``name = partial(function, …)`` or ``name = function``."""
        for st in self.tree.body:
            v = st.value if isinstance(st, ast.Assign) and len(st.targets) == 1 and isinstance(st.targets[0], ast.Name) and st.targets[0].id == name else None
            if v is not None:
                if isinstance(v, ast.Call) and isinstance(v.func, (ast.Name, ast.Attribute)) and (getattr(v.func, "id", "") == "partial" or getattr(v.func, "attr", "") == "partial") and v.args: return v.args[0]
                if isinstance(v, ast.Name) and v.id != name: return v
        return None

    def kw_refs(self, n, keywords, funcs, s, known, call):
        c = self.c
        for kw in keywords:
            if kw.arg is None:
                for kind, f in funcs:
                    if kind == "c" and c.own(f):
                        src = self.raw[self.off(kw.value.lineno, kw.value.col_offset):self.off(kw.value.end_lineno, kw.value.end_col_offset)]
                        by_field = re.search(rb"asdict|vars|fields|__dict__|replace", src)
                        self.reflect([f], "constructed from fields of another" if by_field else "constructed from **", kw.value)
                    if kind == "f": c.starred.setdefault(f, (self.file, n.lineno))
                continue
            keys = []
            for kind, f in funcs:
                if kind == "f":
                    keys += self.param_keys(f, kw.arg)
                else: keys += self.ctor_keys(f, kw.arg)
            keys = list(dict.fromkeys(keys))
            if not keys and call is not None:
                # forwarded to a function among the arguments
                for a in call.args:
                    if isinstance(a, (ast.Name, ast.Attribute)):
                        fs, _ = self.callee_funcs(a, s)
                        for kind, f in fs:
                            keys += self.param_keys(f, kw.arg) if kind == "f" else self.ctor_keys(f, kw.arg)
            if keys: self.ref(kw.lineno, kw.col_offset, kw.arg, keys, "kw", s)
            elif known and any(kind == "f" and c.func_kwargs.get(f) for kind, f in funcs): c.strings.setdefault(kw.arg, []).append((self.file, kw.lineno, "kw"))
            elif not known: c.unres_kw.setdefault(kw.arg, []).append((self.file, kw.lineno))

    def param_keys(self, f, name):
        return [f"{f}({name})"] if name in self.c.func_params.get(f, ()) else []

    def ctor_keys(self, info, name):
        c = self.c
        for b in info.mro:
            sy = b.names.get("__init__")
            if sy is not None and not sy.plugin_generated and b.fullname != "builtins.object":
                ks = self.func_key_of_node(sy.node)
                return [x for k in ks for x in self.param_keys(k, name)]
            if sy is not None and sy.plugin_generated: break
            sy = b.names.get("__new__")
            if sy is not None and not sy.plugin_generated and b.fullname not in ("builtins.object",) and not info.is_named_tuple and not b.fullname.startswith("builtins."):
                ks = self.func_key_of_node(sy.node)
                if ks: return [x for k in ks for x in self.param_keys(k, name)]
        ks = c.member_keys(info, name)
        return [k for k in ks if k != "?"]

    REFLECT = {"asdict": True, "astuple": False, "fields": False, "vars": False, "get_type_hints": False, "fields_of": False, "row_keys": False,
               "keys_of": False, "signature": False}

    def v_Call(self, n, s, ann):
        c = self.c
        f = n.func
        fname = f.id if isinstance(f, ast.Name) else f.attr if isinstance(f, ast.Attribute) else ""
        # handled strings
        if fname in ("getattr", "hasattr", "setattr", "delattr") and len(n.args) >= 2 and (isinstance(f, ast.Name) or isinstance(f, ast.Attribute)):
            self.by_name(n, n.args[0], n.args[1], s, fname)
        elif fname in ("__setattr__", "__delattr__", "__getattribute__") and isinstance(f, ast.Attribute) and n.args:
            if isinstance(f.value, ast.Name) and f.value.id == "object" and len(n.args) >= 2: self.by_name(n, n.args[0], n.args[1], s, fname)
            elif isinstance(n.args[0], ast.Constant): self.c.strings.setdefault(n.args[0].value, []).append((self.file, n.lineno, "kw"))
        elif fname == "object" and isinstance(f, ast.Attribute) and len(n.args) >= 2 and isinstance(n.args[1], ast.Constant):
            self.by_name(n, n.args[0], n.args[1], s, fname)
        elif fname == "cast" and n.args:
            self.visit(n.args[0], s, ann=True); self.cast(n, s)
            for x in n.args[1:]: self.visit(x, s)
            self.visit(f, s); return
        elif fname in ("TypeVar", "NewType", "ParamSpec"):
            self.visit(f, s)
            if s.kind == "module" and isinstance(n.args[0], ast.Constant): self.string_ref(n.args[0], (f"{self.mod}.{n.args[0].value}",), s)
            for x in n.args[1:]: self.visit(x, s, ann=True)
            for k in n.keywords: self.visit(k.value, s, ann=True)
            return
        elif fname in ("attrgetter", "methodcaller"):
            for a in n.args:
                if isinstance(a, ast.Constant) and isinstance(a.value, str):
                    for part in a.value.split("."): c.standin.setdefault(part, []).append((self.file, n.lineno, fname))
        elif fname in self.REFLECT and (isinstance(f, ast.Name) or fname in ("asdict", "fields", "astuple")) and n.args:
            for a in n.args:
                self.reflect(self.receiver_infos(a, s), fname, n, deep=self.REFLECT[fname])
        elif fname == "dict":
            for k in n.keywords:
                if k.arg: c.strings.setdefault(k.arg, []).append((self.file, k.lineno, "kw"))
        elif fname == "SimpleNamespace":
            for k in n.keywords:
                if k.arg: c.standin.setdefault(k.arg, []).append((self.file, k.lineno, "SimpleNamespace"))
        if n.keywords:
            if fname in ("replace", "_replace", "__replace__") :
                target = n.args[0] if isinstance(f, ast.Name) and n.args else f.value if isinstance(f, ast.Attribute) and fname != "replace" else n.args[0] if n.args and isinstance(f, ast.Attribute) and self.foreign_static(f, s) else None
                if target is not None:
                    infos = self.receiver_infos(target, s)
                    for kw in n.keywords:
                        if kw.arg is None: self.reflect(infos, "replace(**)", n); continue
                        keys = [k for i in infos if i is not None for k in c.member_keys(i, kw.arg) if k != "?"]
                        if keys: self.ref(kw.lineno, kw.col_offset, kw.arg, list(dict.fromkeys(keys)), "kw", s)
                        elif None in infos: c.unres_kw.setdefault(kw.arg, []).append((self.file, kw.lineno)); c.unresolved.setdefault(kw.arg, []).append((self.file, kw.lineno, "replace of Any"))
                else:
                    fs, known = self.callee_funcs(f, s); self.kw_refs(n, n.keywords, fs, s, known, n)
            elif fname == "partial" and n.args and self.static_key(f, s) is None:
                fs, known = self.callee_funcs(n.args[0], s); self.kw_refs(n, n.keywords, fs, s, known, None)
            else:
                fs, known = self.callee_funcs(f, s); self.kw_refs(n, n.keywords, fs, s, known, n)
        self.visit(f, s)
        for x in n.args: self.visit(x, s)
        for k in n.keywords: self.visit(k.value, s)

    def cast(self, n, s):
        """cast(Product, stand_in): both have the same member names."""
        if len(n.args) < 2: return
        t = n.args[0]
        if isinstance(t, ast.Constant) and isinstance(t.value, str) and re.fullmatch(r"[\w.]+", t.value): t = ast.parse(t.value, mode="eval").body
        k = self.static_key(t, s); info = self.c.infos.get(k) if k else None
        if info is None: return
        for i in self.receiver_infos(n.args[1], s):
            if i is not None and self.c.own(i) and i is not info:
                self.same_members(i, info, "cast")

    def same_members(self, a, b, why):
        c = self.c
        for x in a.mro:
            if c.own(x):
                for name in x.names:
                    if name.startswith("__"): continue
                    ks = c.member_keys(b, name)
                    if ks and ks != ("?",): c.unions.append((f"{x.fullname}.{name}", ks[0], why))

    def by_name(self, n, obj, name, s, fname):
        c = self.c
        if isinstance(obj, ast.Constant) and isinstance(obj.value, str): return   # setattr("dotted.path", value): text pass
        k = self.static_key(obj, s)
        if isinstance(name, ast.Constant) and isinstance(name.value, str) and name.value.isidentifier():
            if k and (k in c.mods or k in c.packages):
                t = self.target(f"{k}.{name.value}")
                self.seen_strings.add(name)
                if t: self.string_ref(name, (t,), s); c.patched.setdefault(t, (self.file, n.lineno))
                return
            infos = self.receiver_infos(obj, s)
            keys = [x for i in infos if i is not None for x in c.member_keys(i, name.value) if x != "?"]
            if None not in infos: self.seen_strings.add(name)
            if keys:
                self.string_ref(name, list(dict.fromkeys(keys)), s)
                for x in keys: c.patched.setdefault(x, (self.file, n.lineno))
            elif None in infos and not self.foreign_static(obj, s): c.unresolved.setdefault(name.value, []).append((self.file, n.lineno, "getattr of Any"))
        elif fname in ("getattr", "setattr", "hasattr", "delattr"):
            for i in self.receiver_infos(obj, s):
                if i is not None and c.own(i): c.dynamic.setdefault(i.fullname, (self.file, n.lineno))
            if k and k in c.mods: c.dynamic.setdefault(k, (self.file, n.lineno))

def collect(tree, cache=None):
    dbg = pathlib.Path(__file__).parent / 'dbg.py'
    if PRELOADED and dbg.exists():
        exec(dbg.read_text(), globals()); return
    head = hashlib.sha1()
    for f in sources(tree): head.update(f.encode()); head.update(pathlib.Path(tree, f).read_bytes())
    head.update(pathlib.Path(__file__).read_bytes())
    path = pathlib.Path(__file__).parent / "cache" / (head.hexdigest()[:16] + ".pickle")
    if path.exists(): return pickle.loads(path.read_bytes())
    facts = Collector(tree).run()
    path.parent.mkdir(exist_ok=True)
    for old in sorted(path.parent.glob("*.pickle"), key=lambda p: p.stat().st_mtime)[:-3]: old.unlink()
    path.write_bytes(pickle.dumps(facts, protocol=5))
    return facts

if __name__ == "__main__":
    sys.setrecursionlimit(20000)
    t = time.time(); f = collect(sys.argv[1]); print(f"{time.time()-t:.0f} s", {k: len(v) for k, v in f.items()}, sum(map(len, f["refs"].values())))
