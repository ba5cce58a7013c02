# For catkin alone: catkin_python_setup() calls it. Do not run it by hand.
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=['relative_map'], package_dir={'': 'python'}))
