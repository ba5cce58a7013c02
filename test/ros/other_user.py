"""Runs of a tool as somebody who owns nothing, for tests of permissions: root has them all."""

import os
import subprocess
import tempfile

NOBODY = 65534


def options(test):
    """For subprocess.run; the test's folder becomes readable. Skips the test where this can't be done."""
    os.chmod(test.folder, 0o755)
    home = tempfile.TemporaryDirectory()  # rospack keeps its cache there
    test.addCleanup(home.cleanup)
    os.chmod(home.name, 0o777)
    if os.geteuid() != 0:
        return {}

    def become():
        os.setgroups([])
        os.setgid(NOBODY)
        os.setuid(NOBODY)
    try:
        subprocess.run([test.tool(), '--help'], cwd=test.folder, preexec_fn=become, stdout=subprocess.DEVNULL, check=True)
    except (OSError, subprocess.SubprocessError):
        test.skipTest('another user cannot run the tool from where it is')
    return {'preexec_fn': become, 'env': dict(os.environ, ROS_MASTER_URI='http://127.0.0.1:1', ROS_HOME=home.name)}
