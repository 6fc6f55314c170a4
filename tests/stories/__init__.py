"""Stories: the real ``turndesk`` under a real X server, with real keys and a real pointer.

A story in ten lines::

    def test_the_pause_key_holds_the_feed(story: Story) -> None:
        operator = story.begins("G90G94T1\\nM03S600\\nG01X.5F5\\nX0F5\\nM30\\n", tools={1: (0, 0)})
        operator.drives_on()
        operator.starts()                       # both palms, as soon as the prompt offers it
        operator.key("h", "shift")              # a key goes down and comes up; modifiers are keys too
        operator.reaches("FEED HOLD")           # waits for a state of the machine
        operator.sees("TO CONTINUE")             # waits for a text anywhere on the screen
        assert 0 < operator.rests()[0] < .5 * 25.4  # mm, of the simulated slides themselves
        operator.until(lambda: operator.status["execution"] == "FEED_HOLD", "status.json")

``story.begins(program, machine=…, changes=…, tools=…)`` starts the process in a folder of its own, under
a server and a window manager of its own; ``tests.stories.operator`` says what an operator can do and see.
The process is forked from one that has imported the desk (``tests.stories.fork_server``).
Nothing sleeps: ``until`` waits for what shall be, ``keeps`` looks for so long that something stays,
``during`` is how long a hand holds. What is seen comes from a thread in the process (``tests.stories.eyes``);
the product knows nothing of them. A story that fails leaves a picture of the screen in ``story-failures``.
"""
