"""Strings of tests/product that the renaming changed: compare sequences of string constants per file (tokenize)."""
import subprocess, io, tokenize, sys, difflib, collections
def strings(text):
    return [(t.string, t.line.strip()[:110]) for t in tokenize.generate_tokens(io.StringIO(text).readline) if t.type == tokenize.STRING and not t.string.startswith(('"""', "'''", 'r"""'))]
names = subprocess.run(["git","diff","-M30","--name-status","integ","HEAD","--","*.py"],capture_output=True,text=True).stdout.splitlines()
for line in names:
    p = line.split("\t"); 
    if p[0].startswith(("A","D")): continue
    old, new = p[1], p[-1]
    if not new.startswith(tuple(sys.argv[1:])): continue
    a = strings(subprocess.run(["git","show",f"integ:{old}"],capture_output=True,text=True).stdout)
    b = strings(subprocess.run(["git","show",f"HEAD:{new}"],capture_output=True,text=True).stdout)
    sa, sb = [x[0] for x in a], [x[0] for x in b]
    for tag,i1,i2,j1,j2 in difflib.SequenceMatcher(None,sa,sb,autojunk=False).get_opcodes():
        if tag != "equal":
            for k in range(max(i2-i1,j2-j1)):
                o = a[i1+k][0] if i1+k<i2 else "-"; n = b[j1+k] if j1+k<j2 else ("-","")
                if "." in o and "app." in o+"core." and ("core." in o or "app." in o or "drivers." in o): continue
                if any(w in n[1] for w in ("setattr(","attrgetter","patch(","getattr(","mock","delattr")): continue
                print(f"{new}\t{o[:60]}\t{n[0][:60]}\t{n[1]}")
