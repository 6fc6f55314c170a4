"""List all names of a set of packages: full dotted name, signature, first line of docstring."""
import ast, pathlib, sys
root = pathlib.Path(".")
def doc(node):
    d = ast.get_docstring(node)
    return d.split("\n")[0][:110] if d else ""
def walk_attrs(cls):
    seen = {}
    for st in cls.body:
        if isinstance(st, ast.AnnAssign) and isinstance(st.target, ast.Name): seen.setdefault(st.target.id, ast.unparse(st.annotation)[:50])
        elif isinstance(st, ast.Assign):
            for t in st.targets:
                if isinstance(t, ast.Name): seen.setdefault(t.id, "")
    for f in ast.walk(cls):
        if isinstance(f, (ast.Assign, ast.AnnAssign)):
            for t in (f.targets if isinstance(f, ast.Assign) else [f.target]):
                for e in ast.walk(t):
                    if isinstance(e, ast.Attribute) and isinstance(e.ctx, ast.Store) and isinstance(e.value, ast.Name) and e.value.id == "self":
                        seen.setdefault(e.attr, ast.unparse(f.annotation)[:50] if isinstance(f, ast.AnnAssign) else "")
    return seen
def func(node, prefix, out):
    a = node.args
    params = [x.arg for x in a.posonlyargs + a.args + a.kwonlyargs] + ([ "*"+a.vararg.arg] if a.vararg else []) + (["**"+a.kwarg.arg] if a.kwarg else [])
    params = [p for p in params if p not in ("self", "cls")]
    ret = ast.unparse(node.returns)[:40] if node.returns else ""
    deco = [ast.unparse(d) for d in node.decorator_list]
    kind = "property" if any("property" in d for d in deco) else "def"
    out.append(f"{kind} {prefix}.{node.name}({', '.join(params)}) -> {ret}  # {doc(node)}")
def main(paths):
    for path in paths:
        mod = ".".join(path.relative_to(root).with_suffix("").parts)
        tree = ast.parse(path.read_text())
        out = [f"== {mod}  # {doc(tree)}"]
        for st in tree.body:
            if isinstance(st, (ast.FunctionDef, ast.AsyncFunctionDef)): func(st, mod, out)
            elif isinstance(st, ast.ClassDef):
                out.append(f"class {mod}.{st.name}({', '.join(ast.unparse(b) for b in st.bases)})  # {doc(st)}")
                for n, t in walk_attrs(st).items(): out.append(f"attr {mod}.{st.name}.{n}: {t}")
                for m in st.body:
                    if isinstance(m, (ast.FunctionDef, ast.AsyncFunctionDef)) and not (m.name.startswith("__") and m.name != "__init__"): func(m, f"{mod}.{st.name}", out)
            elif isinstance(st, (ast.Assign, ast.AnnAssign)):
                for t in (st.targets if isinstance(st, ast.Assign) else [st.target]):
                    if isinstance(t, ast.Name) and t.id != "__all__": out.append(f"global {mod}.{t.id}")
        print("\n".join(out).replace(mod + ".", "~."))
files = []
for p in sys.argv[1:]:
    q = root / p
    files += [q] if q.is_file() else sorted(x for x in q.rglob("*.py"))
main([f for f in files if f.name != "__init__.py"])
