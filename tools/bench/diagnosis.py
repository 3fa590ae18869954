"""A diagnosis of the paper's rotor (175 elements, 68 sensors, 6 modes, the whole catalogue) with a soft zone hidden
in its core: seconds on one and on two threads, the share of each step, and the time beside that of one identification in the same
run. Arguments: program, generator, folder."""
import json
import subprocess
import sys
import time

rotid, hide, folder = sys.argv[1:4]
deck = folder + "/bench.inp"
subprocess.run([hide, "input/paper_rotor.inp", "-o", deck, "--truth", folder + "/bench.truth", "--seed", "1", "--effect",
                "stiffness_local:depth=0.5,z=0.857,width=0.03,shape=gaussian"], check=True)


def run(*arguments):
    begin = time.perf_counter()
    text = subprocess.run([rotid, *arguments, deck, "--json", "-"], check=False, capture_output=True, text=True).stdout
    return time.perf_counter() - begin, json.loads(text)


identify = min(run("identify", "--no-baseline")[0] for _ in range(5))
print("\ndiagnosis of 175 elements, 68 sensors, 6 modes, a soft zone hidden in the core")
for threads in (1, 2):
    seconds, result = min((run("diagnose", "--threads", str(threads)) for _ in range(3)), key=lambda r: r[0])
    print(f"{threads} thread{'s' if threads > 1 else ''}: {seconds:.2f} s, {seconds / identify:.0f} times one identification; "
          f"verdict {result['verdict']['kind']}")
    whole = sum(step["seconds"] for step in result["steps"])
    print("   " + ", ".join(f"{step['name']} {100 * step['seconds'] / whole:.0f} %" for step in result["steps"]))
