"""Counts the cases in the JUnit files of a directory: prints how many passed and how many failed,
and, on standard error, which failed and what they said. What was skipped is neither."""
import pathlib
import sys
import xml.etree.ElementTree as ElementTree


def faults_of(case):
    return [part for part in case if part.tag in ("failure", "error")]


def words_of(fault):
    message = fault.get("message") or ""
    text = fault.text or ""
    # The text mostly begins with the message.
    return text if message in text else message + "\n" + text


def is_wrapper(file):
    """rostest's own file says of each test only whether it ran; the test writes another."""
    return file.name.startswith("rostest-")


def count(directory):
    passed = failed = 0
    for file in sorted(pathlib.Path(directory).rglob("*.xml")):
        try:
            cases = list(ElementTree.parse(file).getroot().iter("testcase"))
        except ElementTree.ParseError as fault:
            print("FAILED %s: %s" % (file, fault), file=sys.stderr)
            failed += 1
            continue
        for case in cases:
            faults = faults_of(case)
            if faults:
                failed += 1
                print("FAILED %s %s (%s)" % (case.get("classname"), case.get("name"), file.name),
                      file=sys.stderr)
                for fault in faults:
                    print("    " + words_of(fault).strip().replace("\n", "\n    "),
                          file=sys.stderr)
            elif case.find("skipped") is None and not is_wrapper(file):
                passed += 1
    return passed, failed


print(*count(sys.argv[1]))
