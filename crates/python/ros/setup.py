"""Setup script of the ROS package `lizard_ros`, which colcon builds."""

from setuptools import setup

setup(
    name="lizard_ros",
    version="0.2.0",
    packages=["lizard_ros"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/lizard_ros"]),
        ("share/lizard_ros", ["package.xml"]),
    ],
    install_requires=["lizard-robot"],
    license="MIT OR Apache-2.0",
    entry_points={"console_scripts": ["lizard = lizard_ros.node:main"]},
)
