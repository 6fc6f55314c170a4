"""Execution order of a source program with subprograms, jumps, loops and O words."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.expressions import ExpressionReader, Variables
from core.extras.convert.source_lines import SourceLine, SourceStatement, SourceWord, read_words, split_lines
from core.extras.convert.source_options import SourceControl

MAX_EXECUTED_LINES = 300_000
_DEEPEST = 16
_MACRO = re.compile(r"\s*(IF|WHILE|GOTO|END|DO|THEN)\s*(?=[\[#\d])", re.IGNORECASE)
_TOOL_CHANGE = re.compile(r"M\s*0*6(?![\d.])", re.IGNORECASE)
_LOOP_END = re.compile(r"END\s*\d+", re.IGNORECASE)
_ARGUMENTS = {letter: str(n) for n, letter in enumerate("ABCIJK", start=1)} | {
    letter: str(n)
    for letter, n in zip(
        "DEFHMQRSTUVWXYZ", (7, 8, 9, 11, 13, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26), strict=True
    )
}


_JUMPS: Mapping[str, tuple[bool, tuple[str, ...], int]] = {
    "sub": (False, ("endsub",), 1),
    "else": (False, ("endif",), 1),
    "elseif": (False, ("endif",), 1),
    "endwhile": (True, ("while",), 0),
    "endrepeat": (True, ("repeat",), 0),
    "break": (False, ("endwhile", "endrepeat", "while"), 1),
    "continue": (False, ("endwhile", "endrepeat", "while"), 0),
}
"""Jumps of O words: whether backward, the target keywords, and the number of lines after the target."""
_KEYWORDS = frozenset({"if", "while", "repeat", "call"})


class _Return(NamedTuple):
    return_index: int
    remaining_calls: int  # number of further calls
    subprogram_start_index: int
    local_variables: dict[str, float] | None  # of the caller; None if the call shares them


class ProgramFlow:
    """Iterator of the statements of a source program in execution order.

    ``at`` is the index of the next line to execute.
    """

    def __init__(self, texts: Sequence[str], control: SourceControl) -> None:
        self.lines: list[SourceLine] = split_lines(texts, control)
        self.variables = Variables(is_fanuc=control.is_fanuc)
        self.at = 0
        self.ended = False
        self.repeats = 0  # line of the M99 that repeats the main program
        self._control = control
        self._calls: list[_Return] = []
        self._left = MAX_EXECUTED_LINES
        self._executed: set[int] = set()  # indexes of lines
        self._loops: dict[int, int] = {}  # repeat loops: line index and passes left

    def iter_statements(self) -> Iterator[SourceStatement]:
        """Yield the statements in execution order.

        Raises ProgramError if the program cannot be executed, for example because a loop is endless.
        """
        while self.at < len(self.lines) and not self.ended:
            yield from self._execute_line()

    def _execute_line(self) -> Iterator[SourceStatement]:
        line = self.lines[self.at]
        self._executed.add(self.at)
        self.at += 1
        self._count_lines(1, line)
        if line.o_keyword:
            self._o_word(line)
        elif _MACRO.match(line.code, line.words_start_index):
            yield from self._macro(line)
        else:
            yield from self._statement(line)

    def read_subprogram(self, word: SourceWord) -> list[SourceStatement]:
        """Return the executed statements of the LinuxCNC subprogram whose number is in ``word``.

        Raises ProgramError if the file does not contain this subprogram.
        """
        depth, found = len(self._calls), list[SourceStatement]()
        for key in ("<_x", "<_z", "5420", "5422"):
            self.variables.pop(key, None)  # LinuxCNC would follow the contour; this position does not.
        self._enter(word, self._find_sub(f"{word.value:g}"), 1, {str(n): 0.0 for n in range(1, 31)})
        while len(self._calls) > depth and self.at < len(self.lines) and not self.ended:
            found += self._execute_line()
        return found

    def _find_sub(self, name: str) -> int | None:
        return next(
            (k for k, each in enumerate(self.lines) if each.o_word == name and each.o_keyword == "sub"), None
        )

    def _count_lines(self, count: int, line: SourceLine) -> None:
        """Raise ProgramError if the program executes too many lines."""
        self._left -= count
        if self._left < 0:
            raise make_error(line.line_number, 1, "endless", most=MAX_EXECUTED_LINES)

    @property
    def uses_tool_change(self) -> bool:
        """Return whether a line contains M06."""
        return any(_TOOL_CHANGE.search(each.code) for each in self.lines)

    def find_unexecuted_lines(self) -> list[tuple[int, int]]:
        """Return the first and the last line number of each part of the program that was not executed."""
        found: list[tuple[int, int]] = []
        for index, line in enumerate(self.lines):
            code = line.code[line.words_start_index :].strip()
            if not code or line.o_keyword or _LOOP_END.fullmatch(code):
                continue
            if index in self._executed:
                found.append((0, 0))
            elif found and found[-1] != (0, 0):
                found[-1] = found[-1][0], line.line_number
            else:
                found.append((line.line_number, line.line_number))
        return [each for each in found if each != (0, 0)]

    def _statement(self, line: SourceLine) -> Iterator[SourceStatement]:
        statement = read_words(line, self.variables)
        if statement.has_g_code(65):
            self._call_macro(statement)
            return
        m = next((each for each in statement.find_words("M") if each.value in {97, 98, 99}), None)
        if m is None:
            yield statement
            return
        rest = tuple(each for each in statement.words if each is not m and each.letter not in "PLQ")
        if rest:
            yield SourceStatement(statement.line_number, rest, statement.comment)
        if m.value == 99:
            self._return(statement, line)
        else:
            self._call_program(statement, m)

    # --- subprograms

    def _call_program(self, statement: SourceStatement, m: SourceWord) -> None:
        p, loops = statement.find_word("P"), statement.find_word("L")
        if p is None:
            raise make_error(m.line_number, m.column, "subprogram", word=m.text)
        number, count = round(p.value), 1 if loops is None else round(loops.value)
        if loops is None and number > 9999 and self._control.is_fanuc:
            count, number = divmod(number, 10000)
        self._enter(p, self._program(number) if m.value == 98 else self._block(number, p) - 1, count, None)

    def _call_macro(self, statement: SourceStatement) -> None:
        p = statement.find_word("P")
        if p is None:
            raise make_error(statement.line_number, 1, "subprogram", word="G65")
        passed = {
            _ARGUMENTS[word.letter]: word.value for word in statement.words if word.letter in _ARGUMENTS
        }
        loops = statement.find_word("L")
        self._enter(p, self._program(round(p.value)), 1 if loops is None else round(loops.value), passed)

    def _enter(self, p: SourceWord, begin: int | None, count: int, passed: dict[str, float] | None) -> None:
        if begin is None or len(self._calls) >= _DEEPEST:
            raise make_error(p.line_number, p.column, "subprogram", word=p.text)
        if count < 1:
            return
        saved = None
        if passed is not None:
            saved = {key: value for key, value in self.variables.items() if _is_local(key)}
            self._replace_locals(passed)
        self._calls.append(_Return(self.at, count - 1, begin + 1, saved))
        self.at = begin + 1

    def _program(self, number: int) -> int | None:
        return next(
            (
                index
                for index, each in enumerate(self.lines)
                if each.o_word.isdecimal() and int(each.o_word) == number and not each.o_keyword
            ),
            None,
        )

    def _return(self, statement: SourceStatement, line: SourceLine) -> None:
        if not self._calls:
            self.ended, self.repeats = True, line.line_number
            return
        call = self._calls.pop()
        if call.remaining_calls:
            self._calls.append(call._replace(remaining_calls=call.remaining_calls - 1))
            self.at = call.subprogram_start_index
            return
        self.at = call.return_index
        if call.local_variables is not None:
            self._replace_locals(call.local_variables)
        p = statement.find_word("P")
        if p is not None:
            self.at = self._block(round(p.value), p)

    def _block(self, number: float, word: SourceWord) -> int:
        after = range(self.at, len(self.lines))
        for index in (*after, *range(self.at)):
            if self.lines[index].n == number:
                return int(index)
        raise make_error(word.line_number, word.column, "label", word=word.text)

    def contour(self, first: float, last: float, start_index: int) -> tuple[list[SourceStatement], int]:
        """Return the statements of the blocks N``first`` to N``last``, and the index after them.

        The search for the blocks starts at line ``start_index`` and continues from the start of the file.
        Raises ProgramError if the blocks are not found.
        """
        order = (*range(start_index, len(self.lines)), *range(start_index))
        begin = next((index for index in order if self.lines[index].n == first), None)
        end = None
        if begin is not None:
            end = next((k for k in range(begin, len(self.lines)) if self.lines[k].n == last), None)
        if begin is None or end is None:
            raise make_error(start_index, 1, "cycle-contour", first=f"{first:g}", last=f"{last:g}")
        self._executed.update(range(begin, end + 1))
        self._count_lines(end + 1 - begin, self.lines[begin])
        found = [read_words(line, self.variables) for line in self.lines[begin : end + 1]]
        return found, end + 1

    # --- macros of Fanuc

    def _macro(self, line: SourceLine) -> Iterator[SourceStatement]:
        reader = ExpressionReader(line.line_number, line.code, self.variables, line.words_start_index)
        if reader.skip_text("IF"):
            if not reader.read_bracketed_expression():
                return
            if reader.skip_text("THEN"):
                yield from self._statement(line._replace(words_start_index=reader.at))
                return
        if reader.skip_text("WHILE"):
            if not reader.read_bracketed_expression():
                self.at = self._end_of(line, reader) + 1
            return
        if reader.skip_text("GOTO"):
            begin = reader.at
            value, _ = reader.read_value()
            text = line.code[begin : reader.at].strip()
            self._require_line_end(reader)
            self.at = self._block(value, SourceWord("N", value, False, line.line_number, begin + 1, text))
            return
        if reader.skip_text("END"):
            self.at = self._begin_of(line)
            return
        if reader.skip_text("DO"):
            return
        raise make_error(
            line.line_number,
            line.words_start_index + 1,
            "bad-word",
            text=line.code[line.words_start_index :].strip(),
        )

    def _require_line_end(self, reader: ExpressionReader) -> None:
        """Raise ProgramError if more text follows in the line, because this text would have no effect."""
        if reader.peek_character():
            raise make_error(reader.line, reader.at + 1, "bad-word", text=reader.text[reader.at :].strip())

    def _end_of(self, line: SourceLine, reader: ExpressionReader) -> int:
        if not reader.skip_text("DO"):
            raise make_error(line.line_number, reader.at + 1, "bad-word", text=line.code.strip())
        number = line.code[reader.at :].strip()
        for index in range(self.at, len(self.lines)):
            if re.fullmatch(
                rf"END\s*{number}",
                self.lines[index].code[self.lines[index].words_start_index :].strip(),
                re.IGNORECASE,
            ):
                return index
        raise make_error(line.line_number, reader.at + 1, "label", word=f"END{number}")

    def _begin_of(self, line: SourceLine) -> int:
        number = line.code[line.words_start_index :].strip()[3:].strip()
        for index in range(self.at - 1, -1, -1):
            if re.search(rf"DO\s*{number}\s*$", self.lines[index].code, re.IGNORECASE):
                return index
        raise make_error(line.line_number, 1, "label", word=f"DO{number}")

    # --- O words of LinuxCNC

    def _o_word(self, line: SourceLine) -> None:
        reader = ExpressionReader(line.line_number, line.code, self.variables, line.words_start_index)
        jump = _JUMPS.get(line.o_keyword)
        if jump is not None:
            back, keys, beyond = jump
            self.at = (self._find_back if back else self._find)(line, keys) + beyond
        elif line.o_keyword in {"endsub", "return"}:
            self._leave()
        elif line.o_keyword in _KEYWORDS:
            getattr(self, f"_{line.o_keyword}")(line, reader)
            return
        elif line.o_keyword not in {"endif", "do"}:
            raise make_error(line.line_number, line.words_start_index + 1, "bad-word", text=line.code.strip())
        if line.o_keyword not in {"elseif", "endwhile"}:
            self._require_line_end(reader)

    def _while(self, line: SourceLine, reader: ExpressionReader) -> None:
        is_true = self._read_condition(reader)
        if self._is_do_end(line):
            self.at = self._find_back(line, ("do",)) + 1 if is_true else self.at
        elif not is_true:
            self.at = self._find(line, ("endwhile",)) + 1

    def _if(self, line: SourceLine, reader: ExpressionReader) -> None:
        """Execute IF: continue after the first IF or ELSEIF that is true.

        If none is true, continue after ELSE, or after ENDIF if there is no ELSE.
        """
        while not self._read_condition(reader):
            index = self._find(line, ("elseif", "else", "endif"))
            self.at = index + 1
            line = self.lines[index]
            if line.o_keyword != "elseif":
                return
            reader = ExpressionReader(line.line_number, line.code, self.variables, line.words_start_index)

    def _read_condition(self, reader: ExpressionReader) -> bool:
        is_true = bool(reader.read_bracketed_expression())
        self._require_line_end(reader)
        return is_true

    def _is_do_end(self, line: SourceLine) -> bool:
        return any(
            each.o_word == line.o_word and each.o_keyword == "do"
            for each in self.lines[: line.line_number - 1]
        )

    def _repeat(self, line: SourceLine, reader: ExpressionReader) -> None:
        index = line.line_number - 1
        left = self._loops.pop(index, None)
        left = round(reader.read_bracketed_expression()) if left is None else left
        if left <= 0:
            self.at = self._find(line, ("endrepeat",)) + 1
        else:
            self._loops[index] = left - 1

    def _call(self, line: SourceLine, reader: ExpressionReader) -> None:
        begin = self._find_sub(line.o_word)
        passed: dict[str, float] = {}
        while reader.peek_character() == "[":
            passed[str(len(passed) + 1)] = reader.read_bracketed_expression()
        self._require_line_end(reader)
        name = SourceWord("O", 0, True, line.line_number, line.words_start_index, f"O{line.o_word}")
        passed |= {str(n): 0.0 for n in range(len(passed) + 1, 31)}
        self._enter(name, begin, 1, passed)

    def _leave(self) -> None:
        if not self._calls:
            self.ended = True
            return
        call = self._calls.pop()
        self.at = call.return_index
        if call.local_variables is not None:
            self._replace_locals(call.local_variables)

    def _replace_locals(self, values: Mapping[str, float]) -> None:
        for key in [key for key in self.variables if _is_local(key)]:
            del self.variables[key]
        self.variables.update(values)

    def _find(self, line: SourceLine, keys: Sequence[str]) -> int:
        for index in range(line.line_number, len(self.lines)):
            if self.lines[index].o_word == line.o_word and self.lines[index].o_keyword in keys:
                return index
        raise make_error(line.line_number, 1, "label", word=f"O{line.o_word} {keys[0].upper()}")

    def _find_back(self, line: SourceLine, keys: Sequence[str]) -> int:
        for index in range(line.line_number - 2, -1, -1):
            if self.lines[index].o_word == line.o_word and self.lines[index].o_keyword in keys:
                return index
        raise make_error(line.line_number, 1, "label", word=f"O{line.o_word} {keys[0].upper()}")


def _is_local(key: str) -> bool:
    """Return whether a variable is local to one call.

    Local variables are #1 to #33 and names without a leading underscore.
    """
    return (key.isdecimal() and int(key) <= 33) or (key.startswith("<") and not key.startswith("<_"))
